//! `splashdown run`.

use splashdown_run::{RunRequest, RunSettings, Session};

use crate::args::RunArguments;
use crate::console::{self, Verbosity};
use crate::exit::{Exit, Failure};
use crate::interrupt::Interrupt;
use crate::lines::Line;
use crate::reporter::ConsoleReporter;
use crate::{memory, scene_file};

/// Runs a scene, or resumes a run.
pub fn run(arguments: &RunArguments) -> Result<Exit, Failure> {
    if arguments.verbosity.level() == Verbosity::Verbose {
        // Fails only if a subscriber is already set.
        let _ = tracing_subscriber::fmt()
            .with_writer(std::io::stderr)
            .with_target(false)
            .without_time()
            .try_init();
    }
    let outcome = execute(arguments);
    if let (Err(failure), true) = (&outcome, arguments.json) {
        console::print_json(&Line::error(failure));
    }
    outcome
}

fn execute(arguments: &RunArguments) -> Result<Exit, Failure> {
    let settings = settings(arguments)?;
    splashdown_io::atomic::set_sync(!arguments.no_sync);
    let mut request = match (&arguments.scene, &arguments.resume) {
        (_, Some(path)) => RunRequest::resume(path, settings)?,
        (Some(scene), None) => RunRequest::new(scene_file::load(scene)?, settings),
        // The parser requires one of the two.
        (None, None) => return Err(Failure::new(Exit::Usage, "name a scene, or --resume a run")),
    };
    request.out.clone_from(&arguments.out);
    request.timing = arguments.timing;
    memory::check(request.scene(), &request.device())?;
    if !request.scene().output.pictures.is_empty() {
        memory::check_picture(request.scene().output.picture_size)?;
    }
    let mut reporter = ConsoleReporter::new(arguments.json, arguments.verbosity.level());
    let session = Session::start(request, &mut reporter)?;
    // During the start Ctrl-C ends the program at once, because no frame can be lost yet.
    let interrupt = Interrupt::listen();
    let outcome = session.finish(&mut reporter, &|| interrupt.stop());
    reporter.close(outcome, arguments.timing)
}

/// # Errors
/// [`Exit::Usage`] for formats that exclude one another.
fn settings(arguments: &RunArguments) -> Result<RunSettings, Failure> {
    let formats = match &arguments.formats {
        Some(formats) if formats.contains(&None) && formats.iter().any(Option::is_some) => {
            let message = "--formats: `none` cannot be combined with other formats";
            return Err(Failure::new(Exit::Usage, message));
        }
        formats => formats.as_ref().map(|formats| formats.iter().flatten().copied().collect()),
    };
    let mut settings = RunSettings::default();
    settings.device.clone_from(&arguments.device);
    settings.frames = arguments.frames;
    settings.formats = formats;
    settings.surface = !arguments.no_surface;
    settings.min_blob = arguments.min_blob;
    settings.min_neighbours = arguments.min_neighbours;
    settings.pictures = if arguments.no_pictures { Some(Vec::new()) } else { arguments.pictures.clone() };
    settings.quality = arguments.quality;
    settings.film = !arguments.no_film;
    settings.checkpoint_every = arguments.checkpoint_every;
    settings.on_burst = arguments.on_burst;
    Ok(settings)
}
