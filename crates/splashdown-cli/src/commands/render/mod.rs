//! `splashdown render`: the frames of a finished run, drawn again.

mod drawing;
mod moments;
mod options;
mod problems;

use std::path::PathBuf;
use std::time::Instant;

use splashdown_run::{FinishedRun, Recorder, Stop, appearance, films};

use crate::args::RenderArguments;
use crate::exit::{Exit, Failure};
use crate::interrupt::Interrupt;
use crate::{console, human, memory, summary};
use drawing::{Drawing, End};
use moments::moments;
use problems::Problems;

/// Draws the frames. Frames and files that cannot be used are left out and reported at the end.
pub fn run(arguments: &RenderArguments) -> Result<Exit, Failure> {
    let scene = options::scene(arguments)?;
    memory::check_picture(scene.output.picture_size)?;
    let kind = options::kind(arguments, &scene)?;
    let mut finished = FinishedRun::open_for(&arguments.run, &scene, kind)?;
    if arguments.slow > 1.0 {
        finished.slow_down(arguments.slow);
    }
    let mut problems = Problems::default();
    if arguments.timing && !finished.enable_timing() {
        problems.extend(["the device has no timestamps: passes are not measured".to_owned()]);
    }
    let frames = options::selected(arguments, &finished, &mut problems)?;
    problems.extend(finished.problems(|frame| frames.binary_search(&frame).is_ok()));
    problems.extend(appearance::caption_problem(&scene));
    let moments = moments(&frames, arguments.slow);
    let name = arguments.out.clone().unwrap_or_else(|| arguments.run.join("render"));
    let recorder = Recorder::without_film(&name, scene.output.picture_size)?;
    let interrupt = Interrupt::listen_with(
        "Stopping after the current picture; press Ctrl-C again to leave out the film.",
    );
    let mut drawing = Drawing {
        orbit: options::orbit(arguments),
        is_slowed: arguments.slow > 1.0,
        finished,
        recorder,
        problems,
        current: None,
    };
    let begun = Instant::now();
    let end = drawing.draw_all(&moments, &interrupt);
    let seconds = begun.elapsed().as_secs_f64();
    let timings = drawing.finished.take_timings();
    let Drawing { recorder, problems, .. } = drawing;
    let rate = films::frame_rate(scene.frame_rate) / arguments.slow.min(1.0);
    // A second signal leaves out the film.
    let repeats = if interrupt.stop() == Stop::Now { 0 } else { arguments.repeat };
    let (problems, pictures) = close(repeats, rate, recorder, problems)?;
    problems.report();
    if !timings.passes.passes.is_empty() {
        console::print(summary::picture_passes(&timings));
    }
    match end {
        End::Failed(error) => Err(error.into()),
        End::Finished if pictures.count == 0 => Err(problems.failure()),
        End::Finished => {
            console::print(pictures.summary(seconds));
            Ok(Exit::Success)
        }
        End::Interrupted => {
            let (count, all) = (pictures.count, moments.len());
            console::print(format!("Stopped after {count} of {all}: {}", pictures.summary(seconds)));
            Ok(Exit::Interrupted)
        }
    }
}

/// The pictures in a folder.
struct Pictures {
    count: u32,
    folder: PathBuf,
    has_film: bool,
}

impl Pictures {
    /// Their number, and the time in s per picture.
    fn summary(&self, seconds: f64) -> String {
        if self.count == 0 {
            return "no pictures".to_owned();
        }
        let pictures = human::counted(self.count.into(), "picture");
        let film = if self.has_film { " and their film" } else { "" };
        let each = human::duration(seconds / f64::from(self.count));
        format!("{pictures}{film} in `{}` ({each} each)", self.folder.display())
    }
}

/// Waits for the pictures and makes their film, which shows them `repeats` times. A single picture has a film only if it is
/// repeated.
fn close(
    repeats: u32,
    rate: f32,
    recorder: Recorder,
    mut problems: Problems,
) -> Result<(Problems, Pictures), Failure> {
    let (count, folder) = (recorder.frames(), recorder.folder().to_owned());
    let mut has_film = (count > 1 && repeats > 0) || (count == 1 && repeats > 1);
    if let Some(problem) = films::size_problem(recorder.size()).filter(|_| has_film) {
        problems.extend([problem]);
        has_film = false;
    }
    if has_film {
        let failure = recorder.finish_with_film(rate, repeats)?;
        has_film = failure.is_none();
        problems.extend(failure);
    } else {
        recorder.finish()?;
    }
    if count == 0 {
        // The folder is new and empty. One that cannot be removed is harmless.
        let _ = std::fs::remove_dir(&folder);
    }
    Ok((problems, Pictures { count, folder, has_film }))
}
