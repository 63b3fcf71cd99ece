//! `splashdown`, the command line: from a scene file to particles, a watertight mesh, pictures and a film.
//!
//! It translates arguments into options of the libraries, events of a run into console output, and errors into one
//! message and one exit code.

mod args;
mod attributes;
mod commands;
mod console;
mod exit;
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

use std::process::ExitCode;

use clap::Parser;

use args::{Arguments, Command};
use exit::Failure;

fn main() -> ExitCode {
    silence_drivers();
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => {
            // This also prints help and version. A closed pipe is not a failure.
            let _ = error.print();
            return ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(exit::Exit::Usage as u8));
        }
    };
    splashdown_io::set_input_limit(arguments.input_limit);
    match dispatch(&arguments.command).and_then(check_output) {
        Ok(code) => code,
        Err(failure) => {
            console::note(format!("error: {}", failure.message.trim_start_matches("error: ")));
            failure.code()
        }
    }
}

/// Output that could not be written to stdout is an error.
fn check_output(code: ExitCode) -> Result<ExitCode, Failure> {
    match console::output_failure() {
        Some(error) if code == ExitCode::SUCCESS => {
            let message = format!(
                "the standard output could not be written: {error}; the printed results are incomplete"
            );
            Err(Failure::new(exit::Exit::Files, message))
        }
        _ => Ok(code),
    }
}

/// Mesa prints "error: XDG_RUNTIME_DIR is invalid or not set" when adapters are listed on a machine without a desktop.
/// The message is harmless but looks like an error of this program. Any folder in that variable prevents it.
fn silence_drivers() {
    const VARIABLE: &str = "XDG_RUNTIME_DIR";
    if cfg!(target_os = "linux") && std::env::var_os(VARIABLE).is_none() {
        // SAFETY: `main` calls this first, before any other thread exists that could read the environment.
        unsafe { std::env::set_var(VARIABLE, std::env::temp_dir()) };
    }
}

fn dispatch(command: &Command) -> Result<ExitCode, Failure> {
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
        #[cfg(feature = "plot")]
        Command::Plot(arguments) => commands::plot::run(arguments)?,
        #[cfg(not(feature = "plot"))]
        Command::Plot(_) => return Err(commands::not_included("plot", "plot")),
        Command::Bench(arguments) => commands::bench::run(arguments)?,
        Command::Completions(arguments) => commands::completions::run(arguments),
    }
    Ok(ExitCode::SUCCESS)
}
