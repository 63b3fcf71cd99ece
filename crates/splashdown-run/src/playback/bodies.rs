//! The places of the bodies of a run over time.

use splashdown::BodyState;
use splashdown::scene::{Body, Motion, Scene, Script};

use crate::{RunFolder, body_table};

/// The places of a body over time.
#[derive(Debug)]
pub struct Track {
    pub name: String,
    motion: TrackMotion,
}

#[derive(Debug)]
enum TrackMotion {
    /// Times in s, ascending, and states; there is at least one.
    Rows(Vec<(f64, BodyState)>),
    Scripted(Script),
    Static(BodyState),
}

impl Track {
    /// The state at a time in s: that of the nearest row of a table.
    pub fn state(&self, time: f64) -> BodyState {
        match &self.motion {
            TrackMotion::Static(state) => *state,
            TrackMotion::Scripted(script) => {
                let pose = script.pose(time);
                BodyState::at(pose.position, pose.orientation)
            }
            TrackMotion::Rows(rows) => {
                let after = rows.partition_point(|(at, _)| *at < time);
                let (before, after) = (&rows[after.saturating_sub(1)], &rows[after.min(rows.len() - 1)]);
                if time - before.0 < after.0 - time { before.1 } else { after.1 }
            }
        }
    }
}

/// The tracks of the bodies of a scene whose places are known, and why others are unknown.
pub fn tracks(folder: &RunFolder, scene: &Scene) -> (Vec<Track>, Vec<String>) {
    let (mut tracks, mut problems) = (Vec::new(), Vec::new());
    for body in &scene.bodies {
        match motion(folder, body) {
            Ok(motion) => tracks.push(Track { name: body.name.clone(), motion }),
            Err(reason) => problems.push(format!("the body {:?} is not shown: {reason}", body.name)),
        }
    }
    (tracks, problems)
}

fn motion(folder: &RunFolder, body: &Body) -> Result<TrackMotion, String> {
    let path = folder.body(&body.name);
    if path.exists() {
        let mut rows = body_table::read_all(&path).map_err(|error| error.to_string())?;
        rows.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        if !rows.is_empty() {
            return Ok(TrackMotion::Rows(rows));
        }
    }
    match &body.motion {
        Motion::Static => Ok(TrackMotion::Static(BodyState::at(body.mesh.position, body.mesh.rotation))),
        Motion::Scripted(script) => Ok(TrackMotion::Scripted(script.clone())),
        Motion::Dynamic { .. } => Err(format!("`{}` is missing or has no rows", path.display())),
    }
}
