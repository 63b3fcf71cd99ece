//! The places of the bodies of a run over time.

use splashdown::BodyState;
use splashdown::scene::{Body, Motion, Scene, Script, hermite_weights};

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
            TrackMotion::Scripted(script) => scripted(script, time),
            TrackMotion::Rows(rows) => {
                let [before, after] = around(rows, time);
                if time - before.0 < after.0 - time { before.1 } else { after.1 }
            }
        }
    }

    /// The state at a time in s, which may lie between two frames: the rows of a table are interpolated.
    pub fn state_between(&self, time: f64) -> BodyState {
        match &self.motion {
            TrackMotion::Rows(rows) => {
                let [before, after] = around(rows, time);
                if (before.0..after.0).contains(&time) {
                    interpolated(before, after, time)
                } else {
                    self.state(time)
                }
            }
            _ => self.state(time),
        }
    }

    /// Whether the state at a time in s is known: the table has a row within `tolerance` (s) of it.
    pub fn knows(&self, time: f64, tolerance: f64) -> bool {
        match &self.motion {
            TrackMotion::Rows(rows) => {
                around(rows, time).iter().any(|(at, _)| (at - time).abs() <= tolerance)
            }
            _ => true,
        }
    }
}

/// The rows before and after a time in s; the first or the last row twice outside the table.
fn around(rows: &[(f64, BodyState)], time: f64) -> [&(f64, BodyState); 2] {
    let after = rows.partition_point(|(at, _)| *at < time);
    [&rows[after.saturating_sub(1)], &rows[after.min(rows.len() - 1)]]
}

/// The state on a cubic curve with the positions and velocities of two rows; the orientation turns uniformly.
fn interpolated((t0, a): &(f64, BodyState), (t1, b): &(f64, BodyState), time: f64) -> BodyState {
    let span = (t1 - t0) as f32;
    let part = (time - t0) / (t1 - t0);
    let [start, leave, end, arrive] = hermite_weights(part).map(|weight| weight as f32);
    let position =
        start * a.position + leave * span * a.velocity + end * b.position + arrive * span * b.velocity;
    let f = part as f32;
    let mut state = BodyState::at(position, a.orientation.slerp(b.orientation, f));
    state.velocity = a.velocity.lerp(b.velocity, f);
    state.angular_velocity = a.angular_velocity.lerp(b.angular_velocity, f);
    state
}

/// The state of a scripted body at a time in s.
pub fn scripted(script: &Script, time: f64) -> BodyState {
    let pose = script.pose(time);
    let mut state = BodyState::at(pose.position, pose.orientation);
    (state.velocity, state.angular_velocity) = (pose.velocity, pose.angular_velocity);
    state
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
    let mut reason = format!("`{}` is missing or has no rows", path.display());
    if path.exists() {
        match body_table::read_all(&path) {
            Ok(mut rows) if !rows.is_empty() => {
                rows.sort_by(|(a, _), (b, _)| a.total_cmp(b));
                return Ok(TrackMotion::Rows(rows));
            }
            Ok(_) => {}
            Err(error) => reason = error.to_string(),
        }
    }
    // The motion of other bodies does not depend on the run.
    match &body.motion {
        Motion::Static => Ok(TrackMotion::Static(BodyState::at(body.mesh.position, body.mesh.rotation))),
        Motion::Scripted(script) => Ok(TrackMotion::Scripted(script.clone())),
        Motion::Dynamic { .. } => Err(reason),
    }
}

#[cfg(test)]
mod tests {
    use splashdown::glam::{Quat, Vec3};

    use super::*;

    /// A body that falls from rest and turns.
    fn falling(time: f64) -> (f64, BodyState) {
        let t = time as f32;
        let mut state = BodyState::at(Vec3::Y * (1.0 - 5.0 * t * t), Quat::from_rotation_z(2.0 * t));
        (state.velocity, state.angular_velocity) = (Vec3::Y * (-10.0 * t), Vec3::Z * 2.0);
        (time, state)
    }

    fn track(rows: impl Iterator<Item = f64>) -> Track {
        Track { name: "ball".to_owned(), motion: TrackMotion::Rows(rows.map(falling).collect()) }
    }

    #[test]
    fn between_two_rows_a_body_follows_its_velocities() {
        let track = track((0..5).map(|i| 0.1 * f64::from(i)));
        for time in [0.0, 0.1, 0.13, 0.35, 0.4] {
            let (state, expected) = (track.state_between(time), falling(time).1);
            assert!(state.position.distance(expected.position) < 1e-5, "{time}: {state:?}");
            assert!(state.orientation.angle_between(expected.orientation) < 1e-3, "{time}: {state:?}");
        }
        // Control: the nearest row, and a straight line, are elsewhere.
        assert!(track.state(0.13).position.distance(falling(0.13).1.position) > 0.01);
        let line = 0.5 * (falling(0.3).1.position + falling(0.4).1.position);
        assert!(track.state_between(0.35).position.distance(line) > 0.01);
        // Outside the table a body rests.
        assert_eq!(track.state_between(7.0), falling(0.4).1);
    }

    #[test]
    fn a_time_without_a_row_is_not_known() {
        let track = track([0.0, 0.1, 0.2].into_iter());
        assert!([0.0, 0.104, 0.2, 0.249].iter().all(|&time| track.knows(time, 0.05)));
        assert!(!track.knows(0.26, 0.05) && !track.knows(0.15, 0.04));
    }
}
