//! The section `[[body]]`.

use std::collections::HashMap;

use glam::{EulerRot, Quat, Vec3};

use super::{Part, given, needed};
use crate::models;
use crate::scene::formula::{self, Formula};
use crate::scene::keys::MotionWord;
use crate::scene::reader::{Reported, Section};
use crate::scene::script::{Keyframe, Script};
use crate::scene::suggest;
use crate::scene::things::{
    Body, BoundaryKind, Hinge, MeshShape, MeshSource, Motion, Motor, SolidContact, UpAxis,
};

/// Maximum displacement by a formula in m; larger values indicate a mistake.
const MAX_DISPLACEMENT: f64 = 1e6;
/// Maximum rotation by a formula in degrees.
const MAX_DEGREES: f64 = 1e9;

/// Reads all `[[body]]` sections. `duration` is that of the scene in s, if it is known.
pub(super) fn read_bodies(sections: &[Section<'_>], duration: Option<f32>) -> Vec<Part<Body>> {
    let read = |section: &Section<'_>| read_body(section, duration.unwrap_or(0.0));
    read_unique(sections, "bodies", read, |body| &body.name)
}

/// Reads sections whose names must be unique.
pub(super) fn read_unique<T>(
    sections: &[Section<'_>],
    kinds: &str,
    mut read: impl FnMut(&Section<'_>) -> Part<T>,
    name: impl Fn(&T) -> &str,
) -> Vec<Part<T>> {
    let mut names: HashMap<String, String> = HashMap::new();
    let mut one = |section: &Section<'_>| {
        let thing = read(section)?;
        // Bodies are files of these names, and some file systems ignore case. The other kinds have the same rule.
        let own = name(&thing);
        let Some(other) = names.insert(own.to_ascii_lowercase(), own.to_owned()) else { return Ok(thing) };
        let message = if other == own {
            format!("there are two {kinds} called {own:?}")
        } else {
            format!("the names of the {kinds} {other:?} and {own:?} differ only in case")
        };
        Err(section.complain("name", message, "unique names", "rename one of them"))
    };
    sections.iter().map(&mut one).collect()
}

fn read_body(section: &Section<'_>, duration: f32) -> Part<Body> {
    let name = section.name("name");
    let mesh = read_mesh(section);
    let density = section.number("density");
    let velocity = section.numbers("velocity");
    let angular_velocity = section.numbers("angular_velocity");
    let hinge = mesh.as_ref().map_err(|r| *r).and_then(|mesh| read_hinge(section, mesh));
    let friction = section.number("friction");
    let adhesion = section.number("adhesion");
    let contact = read_contact(section);
    let boundary = section.choice::<BoundaryKind>("boundary");
    let shell = section.boolean("shell");
    let half_thickness = section.number("half_thickness");
    let colour = section.numbers("colour");
    let script = mesh.as_ref().map_err(|r| *r).and_then(|mesh| read_script(section, mesh, duration));
    let motion = read_motion(section, script);
    let vector = |v: Option<[f32; 3]>| v.map_or(Vec3::ZERO, Vec3::from);
    let motion = match motion? {
        Motion::Dynamic { density: default, .. } => {
            let (velocity, angular_velocity, hinge) = (vector(velocity?), vector(angular_velocity?), hinge?);
            if let Some(hinge) = &hinge {
                warn_of_hinge(section, hinge, velocity, angular_velocity);
            }
            Motion::Dynamic { density: density?.unwrap_or(default), velocity, angular_velocity, hinge }
        }
        other => other,
    };
    Ok(Body {
        name: needed(name)?,
        mesh: mesh?,
        motion,
        friction: friction?.unwrap_or(0.0),
        adhesion: adhesion?.unwrap_or(0.0),
        contact: contact?,
        boundary: boundary?.unwrap_or(BoundaryKind::Map),
        half_thickness: half_thickness?,
        shell: shell?,
        colour: colour?,
    })
}

/// Warns of velocities that a hinge does not allow.
fn warn_of_hinge(section: &Section<'_>, hinge: &Hinge, velocity: Vec3, angular_velocity: Vec3) {
    if velocity != Vec3::ZERO {
        let message = format!("{} has no effect: the body has a hinge", section.key_path("velocity"));
        section.warn("velocity", message, "a hinged body only turns: give angular_velocity");
    }
    let about = angular_velocity.dot(hinge.axis.normalize_or_zero());
    let across = (angular_velocity.length_squared() - about * about).max(0.0).sqrt();
    if across > 1e-3 * angular_velocity.length() {
        let message = format!(
            "{} is not parallel to the hinge: the body starts with {about:.3} rad/s about it",
            section.key_path("angular_velocity")
        );
        section.warn("angular_velocity", message, "give a multiple of the axis in hinge");
    }
}

/// The keys `contact_friction` and `restitution`.
fn read_contact(section: &Section<'_>) -> Part<SolidContact> {
    let (friction, restitution) = (section.number("contact_friction"), section.number("restitution"));
    let default = SolidContact::default();
    Ok(SolidContact {
        friction: friction?.unwrap_or(default.friction),
        restitution: restitution?.unwrap_or(default.restitution),
    })
}

/// The keys `hinge` and `hinge_point`, and those of the motor.
fn read_hinge(section: &Section<'_>, mesh: &MeshSource) -> Part<Option<Hinge>> {
    let axis = section.numbers::<3>("hinge");
    let point = section.numbers::<3>("hinge_point");
    let motor = read_motor(section);
    let (point, motor) = (point?.map_or(mesh.position, Vec3::from), motor?);
    let Some(axis) = axis? else {
        for name in ["hinge_point", "motor_speed"] {
            if section.has(name) {
                let message = format!("{} is given without a hinge", section.key_path(name));
                let hint = "add the axis, for example hinge = [0, 0, 1]";
                return Err(section.complain(name, message, "", hint));
            }
        }
        return Ok(None);
    };
    let axis = Vec3::from(axis).try_normalize().ok_or_else(|| {
        let message = format!("{} is the zero vector", section.key_path("hinge"));
        section.complain("hinge", message, "any vector except zero", "")
    })?;
    Ok(Some(Hinge { point, axis, motor }))
}

/// The keys `motor_speed` and `motor_torque`.
fn read_motor(section: &Section<'_>) -> Part<Option<Motor>> {
    let (speed, torque) = (section.number("motor_speed"), section.number("motor_torque"));
    let torque = torque?;
    let Some(speed) = speed? else {
        if torque.is_some() {
            let message = format!("{} is given without a speed", section.key_path("motor_torque"));
            let hint = "add motor_speed, in rad/s: one revolution per second is 6.283";
            return Err(section.complain("motor_torque", message, "", hint));
        }
        return Ok(None);
    };
    Ok(Some(Motor { speed, torque }))
}

/// The mesh and its pose: the keys `mesh`, `scale`, `up`, `position` and `rotation`.
pub(super) fn read_mesh(section: &Section<'_>) -> Part<MeshSource> {
    let shape = section.text("mesh");
    let scale = section.scales("scale");
    let up = section.choice::<UpAxis>("up");
    let position = section.numbers("position");
    let rotation = read_rotation(section);
    let text = given(section, "mesh", shape?, "mesh")?;
    let shape = if text.contains(['.', '/', '\\']) {
        MeshShape::File(section.file("mesh", &text)?)
    } else {
        let names: Vec<&str> = models::names().iter().map(|(name, _)| *name).collect();
        if !names.contains(&text.as_str()) {
            let message = format!("{} is not the name of a model: {text:?}", section.key_path("mesh"));
            let hint = suggest::closest(&text, &names).map_or_else(
                || "a file name needs its extension".to_owned(),
                |name| format!("did you mean {name:?}? A file name needs its extension"),
            );
            return Err(section.complain("mesh", message, &names.join(", "), &hint));
        }
        MeshShape::Model(text)
    };
    Ok(MeshSource {
        shape,
        scale: scale?.map_or(Vec3::ONE, Vec3::from),
        up: up?.unwrap_or(UpAxis::Y),
        position: position?.map_or(Vec3::ZERO, Vec3::from),
        rotation: rotation?,
    })
}

/// The key `rotation`: about x, then y, then z, in degrees.
pub(super) fn read_rotation(section: &Section<'_>) -> Part<Quat> {
    Ok(section.numbers("rotation")?.map_or(Quat::IDENTITY, quat_from_degrees))
}

fn quat_from_degrees(degrees: [f32; 3]) -> Quat {
    let [x, y, z] = degrees.map(f32::to_radians);
    Quat::from_euler(EulerRot::ZYX, z, y, x)
}

fn read_motion(section: &Section<'_>, script: Part<Option<Script>>) -> Part<Motion> {
    let word = section.choice::<MotionWord>("motion");
    let script = script?;
    let scripted = script.is_some();
    let word = word?.unwrap_or(if scripted { MotionWord::Scripted } else { MotionWord::Static });
    for name in
        ["density", "velocity", "angular_velocity", "hinge", "hinge_point", "motor_speed", "motor_torque"]
    {
        if section.has(name) && word != MotionWord::Dynamic {
            let message = format!("{} has an effect only on a dynamic body", section.key_path(name));
            section.warn(name, message, "set motion = \"dynamic\", or remove the key");
        }
    }
    match (word, script) {
        (MotionWord::Static, None) => Ok(Motion::Static),
        (MotionWord::Scripted, Some(script)) => Ok(Motion::Scripted(script)),
        (MotionWord::Dynamic, None) => Ok(Motion::Dynamic {
            density: 500.0,
            velocity: Vec3::ZERO,
            angular_velocity: Vec3::ZERO,
            hinge: None,
        }),
        (MotionWord::Scripted, None) => {
            let message = "a scripted body needs a keyframe, move or turn".to_owned();
            Err(section.complain("motion", message, "", "for example turn = [\"0\", \"0\", \"90*t\"]"))
        }
        (other, Some(_)) => {
            let message = format!("a {other} body cannot have keyframes, move or turn");
            Err(section.complain("motion", message, "", "remove motion, or remove the script"))
        }
    }
}

fn read_script(section: &Section<'_>, mesh: &MeshSource, duration: f32) -> Part<Option<Script>> {
    let shift = read_formulas(section, "move", duration, MAX_DISPLACEMENT);
    let turn = read_formulas(section, "turn", duration, MAX_DEGREES);
    let sections = section.sections_if_any("keyframe")?;
    let keyframes: Vec<Part<Keyframe>> = sections.iter().map(|s| read_keyframe(s, mesh)).collect();
    let mut keyframes = keyframes.into_iter().collect::<Part<Vec<_>>>()?;
    let (shift, turn) = (shift?, turn?);
    for (k, pair) in keyframes.windows(2).enumerate() {
        if pair[1].time <= pair[0].time {
            // In single precision, in which they were read: its shortest form is the one in the file.
            let message = format!(
                "{} = {} s is not after the previous keyframe, {} s",
                sections[k + 1].key_path("time"),
                pair[1].time as f32,
                pair[0].time as f32
            );
            let hint = "keyframes must be in order of increasing time";
            return Err(sections[k + 1].complain("time", message, "", hint));
        }
    }
    if keyframes.is_empty() {
        if shift.is_none() && turn.is_none() {
            return Ok(None);
        }
        keyframes.push(Keyframe { time: 0.0, position: mesh.position, orientation: mesh.rotation });
    }
    Ok(Some(Script { keyframes, shift, turn }))
}

fn read_keyframe(section: &Section<'_>, mesh: &MeshSource) -> Part<Keyframe> {
    let time = section.number("time");
    let position = section.numbers("position");
    let rotation = section.numbers("rotation");
    Ok(Keyframe {
        time: f64::from(needed(time)?),
        position: position?.map_or(mesh.position, Vec3::from),
        orientation: rotation?.map_or(mesh.rotation, quat_from_degrees),
    })
}

fn read_formulas(
    section: &Section<'_>,
    name: &str,
    duration: f32,
    limit: f64,
) -> Part<Option<Box<[Formula; 3]>>> {
    let Some(texts) = section.texts::<3>(name)? else { return Ok(None) };
    let refuse = |why: &str, hint: &str| -> Reported {
        section.complain(name, format!("{}: {why}", section.key_path(name)), formula::ALLOWED, hint)
    };
    let parse = |text: &String| Formula::parse(text).map_err(|why| refuse(&why, ""));
    let [x, y, z] = texts.each_ref().map(parse);
    let formulas = Box::new([x?, y?, z?]);
    for (formula, text) in formulas.iter().zip(&texts) {
        let Some(time) = formula.fault(f64::from(duration), limit) else { continue };
        let value = formula.at(time);
        let why = if value.is_finite() {
            format!("{text:?} is {value:.3e} at t = {time:.6} s")
        } else {
            format!("{text:?} is not finite at t = {time:.6} s: it is {value}")
        };
        let hint = "a motion needs moderate finite values from 0 to the scene's duration; max(t, 0.1) avoids a division by zero";
        return Err(refuse(&why, hint));
    }
    Ok(Some(formulas))
}
