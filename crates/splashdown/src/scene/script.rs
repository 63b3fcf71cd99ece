//! Scripted motion: the pose of a body as a function of time.

use glam::{DQuat, DVec3, EulerRot, Quat, Vec3};

use super::curve::hermite_weights;
use super::formula::Formula;

/// A body's pose and velocities.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// Position of the mesh's origin in m.
    pub position: Vec3,
    /// The mesh's rotation.
    pub orientation: Quat,
    /// Velocity of the origin in m/s.
    pub velocity: Vec3,
    /// Angular velocity in rad/s.
    pub angular_velocity: Vec3,
}

/// A prescribed motion: keyframes, and formulas that are added to them.
#[derive(Debug, Clone, PartialEq)]
pub struct Script {
    /// Poses in order of time, at least one. Between them the position is a Catmull-Rom spline, and the
    /// rotation is interpolated at constant angular velocity. The body rests before the first and after the
    /// last keyframe.
    pub keyframes: Vec<Keyframe>,
    /// A displacement in m that is added to the position.
    pub shift: Option<Box<[Formula; 3]>>,
    /// A rotation in degrees about the mesh's own x, then y, then z axis, applied before the keyframes'
    /// rotation.
    pub turn: Option<Box<[Formula; 3]>>,
}

/// A pose at a given time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Keyframe {
    /// Time in s.
    pub time: f64,
    /// Position of the mesh's origin in m.
    pub position: Vec3,
    /// The mesh's rotation.
    pub orientation: Quat,
}

/// Half the interval of the central differences that give the velocities, in s.
const STEP: f64 = 1e-4;

impl Script {
    /// The pose at a time in seconds.
    pub fn pose(&self, time: f64) -> Pose {
        let (position, orientation) = self.place(time);
        // Formulas may be undefined for negative times.
        let (start, end) = ((time - STEP).max(0.0), time.max(0.0) + STEP);
        let (before, turned_before) = self.place(start);
        let (after, turned_after) = self.place(end);
        let span = end - start;
        let turn = turned_after * turned_before.conjugate();
        let turn = if turn.w < 0.0 { -turn } else { turn };
        Pose {
            position: position.as_vec3(),
            orientation: orientation.as_quat(),
            velocity: ((after - before) / span).as_vec3(),
            angular_velocity: (turn.to_scaled_axis() / span).as_vec3(),
        }
    }

    /// An upper bound of the speed in m/s, up to `duration`, of points within `reach` metres of the origin,
    /// estimated from samples.
    pub fn max_speed(&self, duration: f64, reach: f32) -> f32 {
        const SAMPLES: u32 = 400;
        self.times(duration, SAMPLES)
            .map(|time| self.pose(time))
            .map(|pose| pose.velocity.length() + reach * pose.angular_velocity.length())
            .fold(0.0, f32::max)
    }

    /// Times in s up to `duration` at which the motion is examined: `intervals` equal ones, and some between each pair of
    /// keyframes, which may be much closer together.
    pub fn times(&self, duration: f64, intervals: u32) -> impl Iterator<Item = f64> {
        const BETWEEN: u32 = 8;
        let part = |start: f64, end: f64, k: u32, n: u32| start + (end - start) * f64::from(k) / f64::from(n);
        let equal = (0..=intervals).map(move |k| part(0.0, duration, k, intervals));
        let pairs = self.keyframes.windows(2).map(|pair| [pair[0].time, pair[1].time]);
        let between = pairs
            .flat_map(move |[start, end]| (0..=BETWEEN).map(move |k| part(start, end, k, BETWEEN)))
            .filter(move |time| (0.0..=duration).contains(time));
        equal.chain(between)
    }

    fn place(&self, time: f64) -> (DVec3, DQuat) {
        let (mut position, mut orientation) = self.between_keyframes(time);
        if let Some(shift) = &self.shift {
            position += DVec3::from_array(shift.each_ref().map(|formula| formula.at(time)));
        }
        if let Some(turn) = &self.turn {
            let [x, y, z] = turn.each_ref().map(|formula| formula.at(time).to_radians());
            orientation *= DQuat::from_euler(EulerRot::ZYX, z, y, x);
        }
        (position, orientation)
    }

    fn between_keyframes(&self, time: f64) -> (DVec3, DQuat) {
        let keys = &self.keyframes;
        let pose = |key: &Keyframe| (key.position.as_dvec3(), key.orientation.as_dquat());
        let next = keys.partition_point(|key| key.time <= time);
        let (Some(a), Some(b)) = (next.checked_sub(1).and_then(|k| keys.get(k)), keys.get(next)) else {
            let nearest = if next == 0 { keys.first() } else { keys.last() };
            return nearest.map_or((DVec3::ZERO, DQuat::IDENTITY), pose);
        };
        let length = b.time - a.time;
        let f = (time - a.time) / length;
        // The slope at a keyframe is that of the line through its neighbours. At both ends it is zero.
        let slope = |k: usize| {
            if k == 0 || k + 1 == keys.len() {
                return DVec3::ZERO;
            }
            let (p, q) = (&keys[k - 1], &keys[k + 1]);
            (q.position - p.position).as_dvec3() / (q.time - p.time)
        };
        let [start, leave, end, arrive] = hermite_weights(f);
        let position = start * a.position.as_dvec3()
            + leave * length * slope(next - 1)
            + end * b.position.as_dvec3()
            + arrive * length * slope(next);
        (position, a.orientation.as_dquat().slerp(b.orientation.as_dquat(), f))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn formulas(texts: [&str; 3]) -> Option<Box<[Formula; 3]>> {
        Some(Box::new(texts.map(|text| Formula::parse(text).unwrap())))
    }

    fn keyframe() -> Keyframe {
        Keyframe { time: 0.0, position: Vec3::new(1.0, 2.0, 3.0), orientation: Quat::IDENTITY }
    }

    #[test]
    fn velocities_are_derivatives_of_the_formulas() {
        let script = Script {
            keyframes: vec![keyframe()],
            shift: formulas(["0.1*sin(2*t)", "0", "t^2"]),
            turn: formulas(["0", "0", "90*t"]),
        };
        let pose = script.pose(0.5);
        let expected = Vec3::new(1.0 + 0.1 * 1f32.sin(), 2.0, 3.25);
        assert!(pose.position.distance(expected) < 1e-6);
        assert!(pose.velocity.distance(Vec3::new(0.2 * 1f32.cos(), 0.0, 1.0)) < 1e-5);
        let rate = std::f32::consts::FRAC_PI_2;
        assert!(pose.angular_velocity.distance(Vec3::new(0.0, 0.0, rate)) < 1e-4);
        let x = pose.orientation * Vec3::X;
        assert!(x.distance(Vec3::new(0.5f32.sqrt(), 0.5f32.sqrt(), 0.0)) < 1e-5);
        assert!((script.max_speed(1.0, 2.0) - (4.0f32 + 0.0069).sqrt() - 2.0 * rate).abs() < 0.01);
    }

    #[test]
    fn a_formula_undefined_for_negative_times_has_a_velocity_at_the_start() {
        let script = Script { keyframes: vec![keyframe()], shift: formulas(["t^1.5", "0", "0"]), turn: None };
        assert!(script.pose(0.0).velocity.length() < 0.02);
        assert!((script.pose(1.0).velocity.x - 1.5).abs() < 1e-4);
    }

    #[test]
    fn keyframes_are_interpolated_smoothly_and_held_at_both_ends() {
        let key = |time: f64, x: f32, turn: f32| Keyframe {
            time,
            position: Vec3::new(x, 0.0, 0.0),
            orientation: Quat::from_rotation_y(turn),
        };
        let keyframes = vec![key(0.5, 0.0, 0.0), key(1.0, 1.0, 0.5), key(2.0, 1.5, 1.0)];
        let script = Script { keyframes, shift: None, turn: None };
        for (time, x) in [(0.0, 0.0), (0.5, 0.0), (1.0, 1.0), (2.0, 1.5), (9.0, 1.5)] {
            assert!((script.pose(time).position.x - x).abs() < 1e-6, "{time}");
        }
        assert_eq!(script.pose(0.2).velocity, Vec3::ZERO);
        // The velocity is continuous at the middle keyframe: 1.5 m in 1.5 s.
        for time in [0.999, 1.0, 1.001] {
            assert!((script.pose(time).velocity.x - 1.0).abs() < 0.02, "{}", script.pose(time).velocity);
        }
        assert!((script.pose(1.5).angular_velocity.y - 0.5).abs() < 1e-4);
    }
}
