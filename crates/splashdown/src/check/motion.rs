//! Warnings about bodies that move: jumps, high speeds, bodies that do not fit between the walls, and volumes that a piston
//! closes.

use std::f32::consts::TAU;

use glam::Vec3;

use super::shapes::{Closing, closings};
use crate::bodies::SCRIPT_SAMPLES;
use crate::sample;
use crate::scene::{Body, Derived, Domain, Motion, Reported, Scene, Script, Section};

/// Intervals in which a motion is searched for jumps.
const INTERVALS: u32 = 2000;
/// Halvings of an interval. Afterwards it is so short that only a jump moves the body.
const HALVINGS: u32 = 24;
/// The smallest jump, in spacings, that is reported.
const JUMP: f32 = 0.05;
/// A time step that a body shortens by more than this factor is reported.
const MUCH_SHORTER: f32 = 10.0;
/// The largest rotation between two samples of a script, in rad. The device interpolates between the samples.
const TURN: f32 = std::f32::consts::FRAC_PI_4;
/// A body may overlap a wall by this many spacings.
const OVERLAP: f32 = 0.05;
/// A piston may compress the fluid by this fraction without a warning, which is within the error of counting particles.
const COMPRESSION: f32 = 0.03;

pub(super) const AXES: [&str; 3] = ["x", "y", "z"];

/// Warns of problems of a body whose mesh has these corners at the start, and this distance from its origin.
///
/// # Errors
/// If the body turns too fast for the samples of its motion.
pub(super) fn check(
    scene: &Scene,
    body: &Body,
    corners: (Vec3, Vec3),
    reach: f32,
    section: &Section<'_>,
) -> Result<(), Reported> {
    match &body.motion {
        Motion::Static => {}
        Motion::Scripted(script) => {
            if !warn_of_jump(scene, body, script, reach, section) {
                refuse_of_turn(scene, body, script, section)?;
                warn_of_speed(scene, body, script, reach, section);
            }
            warn_of_pistons(scene, body, script, corners, section);
        }
        Motion::Dynamic { .. } => warn_of_walls(scene, body, corners, section),
    }
    Ok(())
}

/// Returns whether there is a jump.
fn warn_of_jump(scene: &Scene, body: &Body, script: &Script, reach: f32, section: &Section<'_>) -> bool {
    let least = JUMP * scene.fluid.particle_spacing;
    let Some((time, length)) = jump(script, scene.duration.into(), reach, least) else { return false };
    let message = format!("body {:?} jumps by {length:.3} m at {time:.4} s", body.name);
    let hint = "fluid in its way is pushed away at any speed: use formulas without floor() or divisions that jump, or keyframes";
    section.warn("move", message, hint);
    true
}

/// The time in s and the length in m of the first jump of at least this length.
fn jump(script: &Script, duration: f64, reach: f32, least: f32) -> Option<(f64, f32)> {
    let distance = |from: f64, to: f64| {
        let (a, b) = (script.pose(from), script.pose(to));
        a.position.distance(b.position) + reach * a.orientation.angle_between(b.orientation)
    };
    (0..INTERVALS).find_map(|k| {
        let at = |k: u32| duration * f64::from(k) / f64::from(INTERVALS);
        let (mut start, mut end) = (at(k), at(k + 1));
        let mut length = distance(start, end);
        for _ in 0..HALVINGS {
            if length < least {
                return None;
            }
            let middle = 0.5 * (start + end);
            let (first, second) = (distance(start, middle), distance(middle, end));
            (start, end, length) =
                if first >= second { (start, middle, first) } else { (middle, end, second) };
        }
        (length >= least).then_some((end, length))
    })
}

/// Refuses a rotation that the samples of a frame do not resolve: the body would turn slower, or backwards.
fn refuse_of_turn(
    scene: &Scene,
    body: &Body,
    script: &Script,
    section: &Section<'_>,
) -> Result<(), Reported> {
    let duration = f64::from(scene.duration);
    let spins = script.times(duration, INTERVALS).map(|time| script.pose(time).angular_velocity.length());
    let fastest = spins.fold(0.0, f32::max);
    let samples = (SCRIPT_SAMPLES - 1) as f32;
    let angle = fastest * scene.frame_duration() / samples;
    if angle <= TURN {
        return Ok(());
    }
    let message = format!(
        "body {:?} turns at up to {:.1} revolutions per second, {:.0} degrees in a {samples}th of a frame",
        body.name,
        fastest / TAU,
        angle.to_degrees()
    );
    let allowed = format!("at most {:.0} degrees in a {samples}th of a frame", TURN.to_degrees());
    let hint = format!(
        "set scene.frame_rate to at least {:.0}, or turn it slower",
        (fastest / (TURN * samples)).ceil()
    );
    Err(section.complain("turn", message, &allowed, &hint))
}

/// Warns of a body whose speed shortens the time step much: it moves by at most a spacing per step.
fn warn_of_speed(scene: &Scene, body: &Body, script: &Script, reach: f32, section: &Section<'_>) {
    let speed = script.max_speed(scene.duration.into(), reach);
    let mut without = scene.clone();
    without.bodies.clear();
    let usual = Derived::without_particles(&without).dt_estimate;
    let by_speed = scene.solver.cfl_factor * scene.fluid.particle_spacing / speed;
    let shortened = Derived::without_particles(scene).dt_estimate.min(by_speed);
    if usual > MUCH_SHORTER * shortened {
        let message = format!(
            "body {:?} moves at up to {speed:.1} m/s, which shortens the time step from {usual:.1e} to {shortened:.1e} s",
            body.name
        );
        section.warn("move", message, "make its motion slower, or keyframes farther apart in time");
    }
}

/// Warns of a dynamic body that overlaps closed sides at the start.
fn warn_of_walls(scene: &Scene, body: &Body, (low, high): (Vec3, Vec3), section: &Section<'_>) {
    let Domain { min, max, closed, .. } = &scene.domain;
    let slack = OVERLAP * scene.fluid.particle_spacing;
    for axis in 0..3 {
        let name = AXES[axis];
        let (length, room) = (high[axis] - low[axis], max[axis] - min[axis]);
        if closed[axis] == [true; 2] && length > room + slack {
            let message = format!(
                "body {:?} does not fit between the walls: it is {length:.3} m long along {name}, and they are {room:.3} m apart",
                body.name
            );
            section.warn("scale", message, "make the body smaller or the domain larger");
            continue;
        }
        let overlaps = [("min", min[axis] - low[axis]), ("max", high[axis] - max[axis])];
        for ((side, overlap), closed) in overlaps.into_iter().zip(closed[axis]) {
            if closed && overlap > slack {
                let message =
                    format!("body {:?} reaches {overlap:.3} m into the wall {name}_{side}", body.name);
                section.warn("position", message, "a dynamic body must start between the walls: move it");
            }
        }
    }
}

/// Warns of closed volumes that become smaller than the fluid in them.
fn warn_of_pistons(
    scene: &Scene,
    body: &Body,
    script: &Script,
    corners: (Vec3, Vec3),
    section: &Section<'_>,
) {
    let closings = closings(scene, script, corners);
    if closings.is_empty() {
        return;
    }
    let Ok(particles) = sample::particles(scene) else { return };
    for Closing { side, low, high, least, .. } in closings {
        let inside = |x: &&[f32; 3]| (0..3).all(|axis| (low[axis]..=high[axis]).contains(&x[axis]));
        let fluid =
            particles.positions.iter().filter(inside).count() as f32 * scene.fluid.particle_spacing.powi(3);
        if fluid > (1.0 + COMPRESSION) * least {
            let message = format!(
                "body {:?} closes the volume at {side} and compresses it to {least:.3e} m^3, but it contains {fluid:.3e} m^3 of \
                 fluid, which cannot escape",
                body.name
            );
            section.warn("move", message, "shorten the stroke, open a side of the domain, or use less fluid");
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::Quat;

    use super::jump;
    use crate::scene::{Formula, Keyframe, Script};

    fn script(x: &str, turn: &str) -> Script {
        let formulas = |texts: [&str; 3]| Some(Box::new(texts.map(|text| Formula::parse(text).unwrap())));
        let position = glam::Vec3::ZERO;
        Script {
            keyframes: vec![Keyframe { time: 0.0, position, orientation: Quat::IDENTITY }],
            shift: formulas([x, "0", "0"]),
            turn: formulas(["0", turn, "0"]),
        }
    }

    #[test]
    fn jumps_are_found_and_fast_motion_is_none() {
        let (time, length) = jump(&script("0.2*floor(t/0.7)", "0"), 2.0, 1.0, 1e-3).unwrap();
        assert!((time - 0.7).abs() < 1e-6 && (length - 0.2).abs() < 1e-3, "{time} {length}");
        let (time, _) = jump(&script("0", "30*floor(t)"), 2.0, 1.0, 1e-3).unwrap();
        assert!((time - 1.0).abs() < 1e-6);
        // A jump within a fast motion, and a short one.
        assert!(jump(&script("20*t+0.01*floor(t)", "0"), 2.0, 1.0, 1e-3).is_some());
        for smooth in ["50*sin(40*t)", "0.1*tanh(1000*(t-1))", "t^3"] {
            assert_eq!(jump(&script(smooth, "360*50*t"), 2.0, 1.0, 1e-3), None, "{smooth}");
        }
    }
}
