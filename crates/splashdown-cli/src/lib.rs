//! `splashdown`, the command line: from a scene file to particles, a watertight mesh, pictures and a film.
//!
//! It translates arguments into options of the libraries, events of a run into console output, and errors into one
//! message and one exit code.
//!
//! It is a library so that the Python package contains the command without a second copy of the program: [`run`] is its
//! only item.

mod args;
mod attributes;
mod commands;
mod console;
mod exit;
mod forecast;
mod human;
mod interrupt;
mod lines;
mod memory;
#[cfg(feature = "plot")]
mod plot;
mod progress;
mod reporter;
mod scene_file;
mod speed;
mod summary;

use std::ffi::OsString;

use args::{Arguments, Command};
use exit::{Exit, Failure};

/// Runs a command line and returns the exit code of the process. The first argument is the name of the program. Output
/// goes to stdout and stderr; `splashdown --help` lists the codes.
///
/// ```
/// assert_eq!(splashdown_cli::run(["splashdown", "scenes"]), 0);
/// assert_eq!(splashdown_cli::run(["splashdown", "no-such-command"]), 2);
/// ```
#[must_use]
pub fn run(arguments: impl IntoIterator<Item = impl Into<OsString> + Clone>) -> u8 {
    let arguments = match Arguments::read(arguments) {
        Ok(arguments) => arguments,
        Err(error) => {
            // This also prints help and version. A closed pipe is not a failure.
            let _ = error.print();
            return u8::try_from(error.exit_code()).unwrap_or(Exit::Usage as u8);
        }
    };
    interrupt::report_file_size_limit();
    splashdown_io::set_input_limit(arguments.input_limit);
    match dispatch(&arguments.command).and_then(check_output) {
        Ok(exit) => exit as u8,
        Err(failure) => {
            console::note(format!("error: {}", failure.message.trim_start_matches("error: ")));
            failure.exit as u8
        }
    }
}

/// Output that could not be written to stdout is an error.
fn check_output(exit: Exit) -> Result<Exit, Failure> {
    match console::output_failure() {
        Some(error) if exit == Exit::Success => {
            let message = format!(
                "the standard output could not be written: {error}; the printed results are incomplete"
            );
            Err(Failure::new(Exit::Files, message))
        }
        _ => Ok(exit),
    }
}

fn dispatch(command: &Command) -> Result<Exit, Failure> {
    match command {
        Command::Run(arguments) => return commands::run::run(arguments),
        #[cfg(feature = "window")]
        Command::View(arguments) => commands::view::view(arguments)?,
        #[cfg(not(feature = "window"))]
        Command::View(_) => return Err(commands::not_included("view", "window")),
        Command::Check(arguments) => commands::check::run(arguments)?,
        Command::Doctor(arguments) => commands::doctor::run(arguments),
        Command::Scenes(arguments) => commands::scenes::run(arguments)?,
        Command::Surface(arguments) => commands::surface::run(arguments)?,
        Command::Render(arguments) => return commands::render::run(arguments),
        #[cfg(feature = "plot")]
        Command::Plot(arguments) => commands::plot::run(arguments)?,
        #[cfg(not(feature = "plot"))]
        Command::Plot(_) => return Err(commands::not_included("plot", "plot")),
        Command::Bench(arguments) => commands::bench::run(arguments)?,
        Command::Completions(arguments) => commands::completions::run(arguments),
    }
    Ok(Exit::Success)
}
