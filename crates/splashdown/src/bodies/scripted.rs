//! The motion of a scripted body during a frame, sampled on the host.

use glam::{Quat, Vec3, Vec4};

use super::{SCRIPT_SAMPLES, ScriptSample};
use crate::scene::Script;

/// The motion of a scripted body.
#[derive(Clone, Debug)]
pub(super) struct ScriptedMotion {
    pub script: Script,
    /// The largest distance of a point of its mesh from its origin, in m.
    pub reach: f32,
}

impl ScriptedMotion {
    /// The samples of a frame. `start` and `duration` in seconds.
    pub fn sample(&self, start: f64, duration: f64) -> Vec<ScriptSample> {
        let at = |k: usize| start + duration * k as f64 / (SCRIPT_SAMPLES - 1) as f64;
        let sample = |k: usize| {
            let pose = self.script.pose(at(k));
            ScriptSample {
                position: pose.position,
                orientation: Vec4::from(pose.orientation),
                velocity: pose.velocity,
                angular_velocity: pose.angular_velocity,
                ..bytemuck::Zeroable::zeroed()
            }
        };
        (0..SCRIPT_SAMPLES).map(sample).collect()
    }

    /// The largest speed of a point of the body in m/s between these samples of a frame of `duration` seconds, where the body
    /// reaches into the box. It is the mean over the interval: a jump has no speed.
    pub fn speed_in(&self, samples: &[ScriptSample], duration: f64, (low, high): (Vec3, Vec3)) -> f32 {
        let interval = duration as f32 / (SCRIPT_SAMPLES - 1) as f32;
        let is_near = |sample: &ScriptSample| {
            let nearest = sample.position.clamp(low, high);
            nearest.distance(sample.position) <= self.reach
        };
        let speed = |a: &ScriptSample, b: &ScriptSample| {
            let between = Quat::from_vec4(a.orientation).conjugate() * Quat::from_vec4(b.orientation);
            // The arc cosine of `angle_between` is inexact for small angles.
            let turn = 2.0 * between.xyz().length().atan2(between.w.abs());
            (a.position.distance(b.position) + self.reach * turn) / interval
        };
        let pairs = samples.iter().zip(samples.iter().skip(1));
        let near = pairs.filter(|(a, b)| is_near(a) || is_near(b));
        near.map(|(a, b)| speed(a, b)).filter(|speed| speed.is_finite()).fold(0.0, f32::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Formula, Keyframe};

    fn motion(x: &str, turn: &str) -> ScriptedMotion {
        let formulas = |texts: [&str; 3]| Some(Box::new(texts.map(|text| Formula::parse(text).unwrap())));
        let keyframes = vec![Keyframe { time: 0.0, position: Vec3::ZERO, orientation: Quat::IDENTITY }];
        let script = Script { keyframes, shift: formulas([x, "0", "0"]), turn: formulas(["0", turn, "0"]) };
        ScriptedMotion { script, reach: 0.5 }
    }

    fn speed(x: &str, turn: &str) -> f32 {
        let motion = motion(x, turn);
        motion.speed_in(&motion.sample(1.0, 0.1), 0.1, (Vec3::splat(-1.0), Vec3::ONE))
    }

    #[test]
    fn the_speed_of_a_frame_is_that_of_the_fastest_point_in_the_box() {
        assert!((speed("0.4*(t-1)", "180*t") - 0.4 - 0.5 * std::f32::consts::PI).abs() < 1e-3);
        // The frame from 1 to 1.1 s: fast only while the body is away, and a body that never comes.
        assert!((speed("3*(t-1)", "0") - 3.0).abs() < 1e-3);
        assert_eq!(speed("10+50*t", "0"), 0.0);
        // A jump by 0.2 m counts as motion over one of 64 intervals.
        let jump = speed("0.2*floor(t/1.05)", "0");
        assert!((jump / (0.2 * 64.0 / 0.1) - 1.0).abs() < 1e-3, "{jump}");
    }
}
