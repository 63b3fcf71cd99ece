//! What the options select: scene, camera, frames, and what is drawn of them.

use std::path::Path;

use splashdown::scene::{CameraPath, PictureKind, Scene};
use splashdown_run::{FinishedRun, Orbit, RunFrames, scene_of_run};

use super::problems::Problems;
use crate::args::{FrameRange, RenderArguments};
use crate::exit::{Exit, Failure};
use crate::{human, scene_file};

/// Where the camera stands relative to that of the scene.
pub fn orbit(arguments: &RenderArguments) -> Orbit {
    Orbit {
        azimuth: arguments.azimuth,
        turn: arguments.turn,
        elevation: arguments.elevation,
        distance: arguments.distance,
    }
}

/// The selected frames that exist. Missing ones are a problem.
///
/// # Errors
/// [`Exit::Usage`] if there is none.
pub fn selected(
    arguments: &RenderArguments,
    finished: &FinishedRun,
    problems: &mut Problems,
) -> Result<Vec<u32>, Failure> {
    let all: Vec<u32> = finished.frames().collect();
    let (low, high) = (all.first().copied().unwrap_or(0), all.last().copied().unwrap_or(0));
    let range = arguments.frames.unwrap_or(FrameRange { first: low, last: None });
    let last = range.last.unwrap_or(high);
    let frames: Vec<u32> = all.into_iter().filter(|frame| (range.first..=last).contains(frame)).collect();
    if frames.is_empty() {
        let wanted = match range.last {
            Some(last) => format!("the frames {} to {last}", range.first),
            None => format!("frame {} and later ones", range.first),
        };
        let run = arguments.run.display();
        let message = format!("`{run}` has nothing to draw of {wanted}; it has frames {low} to {high}");
        return Err(Failure::new(Exit::Usage, message));
    }
    let missing = u64::from(last - range.first) + 1 - frames.len() as u64;
    if missing > 0 {
        problems.extend([format!("{} without a file left out", human::counted(missing, "frame"))]);
    }
    Ok(frames)
}

/// What the pictures show: the surface, if the run has one.
///
/// # Errors
/// [`Exit::Usage`] for colours of a surface.
pub fn kind(arguments: &RenderArguments, scene: &Scene) -> Result<PictureKind, Failure> {
    match (arguments.pictures, arguments.colour_by) {
        (Some(PictureKind::Surface), Some(_)) => {
            let message = "--colour-by colours particles: give --pictures particles";
            Err(Failure::new(Exit::Usage, message))
        }
        (Some(kind), _) => Ok(kind),
        (None, Some(_)) => Ok(PictureKind::Particles),
        (None, None) => {
            let has_frames = RunFrames::exist_in(&arguments.run);
            let only_particles = has_frames && {
                let frames = RunFrames::open(&arguments.run, Some(scene.clone()))?;
                frames.has_particles_and_meshes() == (true, false)
            };
            Ok(if only_particles { PictureKind::Particles } else { PictureKind::Surface })
        }
    }
}

/// The scene of the run, with the changes of the command line.
///
/// # Errors
/// [`Exit::Usage`] for invalid options or an unknown scene; the problems of a scene or a camera path.
pub fn scene(arguments: &RenderArguments) -> Result<Scene, Failure> {
    if !arguments.run.is_dir() {
        let message =
            format!("`{}` is not a folder: give the output folder of a run", arguments.run.display());
        return Err(Failure::new(Exit::Usage, message));
    }
    if arguments.elevation.is_some_and(|elevation| !(-89.0..=89.0).contains(&elevation)) {
        return Err(Failure::new(Exit::Usage, "--elevation: the elevation is between -89 and 89 degrees"));
    }
    let mut scene = match &arguments.scene {
        Some(path) => scene_file::load(path)?,
        None => scene_of_run(&arguments.run)?,
    };
    if let Some(path) = &arguments.camera_path {
        scene.camera_path = camera_path(path, &scene)?;
    }
    scene.surface.min_blob = arguments.min_blob.unwrap_or(scene.surface.min_blob);
    scene.surface.min_neighbours = arguments.min_neighbours.unwrap_or(scene.surface.min_neighbours);
    let output = &mut scene.output;
    output.quality = arguments.quality;
    output.picture_size = arguments.size.unwrap_or(output.picture_size);
    if let Some(quantity) = arguments.colour_by.filter(|quantity| *quantity != output.colour_by) {
        // The range of the scene is that of another quantity.
        (output.colour_by, output.colour_range) = (quantity, None);
    }
    Ok(scene)
}

/// Reads a file with a camera path.
fn camera_path(path: &Path, scene: &Scene) -> Result<CameraPath, Failure> {
    let text = std::fs::read_to_string(path).map_err(|error| {
        Failure::new(Exit::Scene, format!("cannot read the camera path `{}`: {error}", path.display()))
    })?;
    Ok(CameraPath::parse(&text, &path.display().to_string(), &scene.camera)?)
}
