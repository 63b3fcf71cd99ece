//! `splashdown render`: the frames of a finished run, drawn again.

use std::time::Instant;

use splashdown::scene::Scene;
use splashdown_run::{FinishedRun, Orbit, Recorder, appearance, films, reported_scene};

use crate::args::RenderArguments;
use crate::exit::{Exit, Failure};
use crate::{console, human, scene_file};

/// Draws the frames.
pub fn run(arguments: &RenderArguments) -> Result<(), Failure> {
    let mut scene = scene(arguments)?;
    scene.output.quality = arguments.quality;
    scene.surface.min_blob = arguments.min_blob.unwrap_or(scene.surface.min_blob);
    scene.surface.min_neighbours = arguments.min_neighbours.unwrap_or(scene.surface.min_neighbours);
    scene.output.picture_size = arguments.size.unwrap_or(scene.output.picture_size);
    if arguments.elevation.is_some_and(|elevation| !(-89.0..=89.0).contains(&elevation)) {
        return Err(Failure::new(Exit::Usage, "--elevation: the elevation is between -89 and 89 degrees"));
    }
    let mut finished = FinishedRun::open(&arguments.run, &scene)?;
    let frames = selected(arguments, &finished)?;
    let orbit = Orbit {
        azimuth: arguments.azimuth,
        turn: arguments.turn,
        elevation: arguments.elevation,
        distance: arguments.distance,
    };
    let name = arguments.out.clone().unwrap_or_else(|| arguments.run.join("render"));
    let rate = films::frame_rate(scene.frame_rate) / arguments.slow;
    let (mut recorder, failure) = Recorder::start(&name, scene.output.picture_size, rate)?;
    if let Some(reason) = failure.filter(|_| frames.len() > 1) {
        console::note(format!("warning: {reason}"));
    }
    if let Some(problem) = appearance::caption_problem(&scene) {
        console::note(format!("warning: {problem}"));
    }
    let begun = Instant::now();
    for (number, &frame) in frames.iter().enumerate() {
        let progress = number as f32 / (frames.len() - 1).max(1) as f32;
        let picture = finished.draw(frame, &orbit, progress)?;
        recorder.add(picture.rgba.clone())?;
        let spent = begun.elapsed().as_secs_f64();
        let left = spent / (number + 1) as f64 * (frames.len() - number - 1) as f64;
        console::note(format!(
            "[{}/{}] frame {frame}, {} left",
            number + 1,
            frames.len(),
            human::duration(left)
        ));
    }
    let folder = recorder.folder().to_owned();
    recorder.finish()?;
    console::print(format!(
        "{} in `{}` ({} each)",
        human::counted(frames.len() as u64, "picture"),
        folder.display(),
        human::duration(begun.elapsed().as_secs_f64() / frames.len() as f64)
    ));
    Ok(())
}

/// The selected frames that exist. Missing ones are reported once.
fn selected(arguments: &RenderArguments, finished: &FinishedRun) -> Result<Vec<u32>, Failure> {
    let (first, last) = match (arguments.frames, finished.frames().min().zip(finished.frames().max())) {
        (Some(range), _) => range,
        (None, Some(range)) => range,
        (None, None) => (0, 0),
    };
    let frames: Vec<u32> = finished.frames().filter(|frame| (first..=last).contains(frame)).collect();
    if frames.is_empty() {
        let all: Vec<u32> = finished.frames().collect();
        let message = format!(
            "`{}` has no mesh of the frames {first} to {last}; it has those of {} to {}",
            arguments.run.display(),
            all.first().copied().unwrap_or_default(),
            all.last().copied().unwrap_or_default()
        );
        return Err(Failure::new(Exit::Usage, message));
    }
    let missing = u64::from(last - first) + 1 - frames.len() as u64;
    if missing > 0 {
        console::note(format!("warning: {} without a mesh left out", human::counted(missing, "frame")));
    }
    Ok(frames)
}

/// The scene of the run: the given one, or the one that its report names.
fn scene(arguments: &RenderArguments) -> Result<Scene, Failure> {
    if !arguments.run.is_dir() {
        let message =
            format!("`{}` is not a folder: give the output folder of a run", arguments.run.display());
        return Err(Failure::new(Exit::Usage, message));
    }
    if let Some(path) = &arguments.scene {
        return scene_file::load(path);
    }
    Ok(reported_scene(&arguments.run)?)
}
