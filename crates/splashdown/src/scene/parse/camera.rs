//! The section `[camera]` and files of camera paths.

use glam::Vec3;
use toml::de::DeTable;

use super::{Part, needed};
use crate::scene::camera_path::{CameraKeyframe, CameraPath};
use crate::scene::errors::{SceneErrors, SceneProblem};
use crate::scene::framing;
use crate::scene::keys::CAMERA_PATH;
use crate::scene::reader::{Reader, Reported, Section};
use crate::scene::source::Source;
use crate::scene::types::{Camera, Domain};

/// Largest elevation in degrees of a camera that is given by its eye: above, "up" in the picture has no direction.
const MAX_ELEVATION: f32 = 89.0;
/// Smallest distance in m of the eye from the target, as that of the key `distance`.
const MIN_DISTANCE: f32 = 1e-4;

pub(super) fn read_camera(
    section: &Section<'_>,
    domain: Option<&Domain>,
    picture: [u32; 2],
    duration: f32,
) -> Part<(Camera, CameraPath)> {
    let target = section.numbers("target");
    let distance = section.number("distance");
    let azimuth = section.number("azimuth");
    let elevation = section.number("elevation");
    let field_of_view = section.number("field_of_view");
    let orbit_speed = section.number("orbit_speed");
    let keyframes = section.sections_if_any("keyframe");
    let camera = Camera {
        target: Vec3::ZERO,
        distance: 1.0,
        azimuth: azimuth?.unwrap_or(25.0),
        elevation: elevation?.unwrap_or(20.0),
        field_of_view: field_of_view?.unwrap_or(35.0),
        orbit_speed: orbit_speed?.unwrap_or(0.0),
    };
    let (target, distance) = (target?.map(Vec3::from), distance?);
    let domain = domain.ok_or(Reported)?;
    let aimed = Camera { target: target.unwrap_or_else(|| domain.center()), ..camera };
    let fitting = || framing::fitting_distance(&aimed, domain, picture, duration);
    let camera = Camera { distance: distance.unwrap_or_else(fitting), ..aimed };
    Ok((camera, read_path(&keyframes?, &camera)?))
}

/// Reads keyframes; `camera` has the values that they do not give.
fn read_path(sections: &[Section<'_>], camera: &Camera) -> Part<CameraPath> {
    let mut keyframes: Vec<CameraKeyframe> = Vec::new();
    let mut problem = None;
    for section in sections {
        let read = read_keyframe(section)
            .and_then(|key| check(section, &key, keyframes.last(), camera).map(|()| key));
        match read {
            Ok(keyframe) => keyframes.push(keyframe),
            Err(reported) => problem = Some(reported),
        }
    }
    problem.map_or(Ok(CameraPath { keyframes }), Err)
}

fn read_keyframe(section: &Section<'_>) -> Part<CameraKeyframe> {
    let time = section.number("time");
    let target = section.numbers("target");
    let eye = section.numbers("eye");
    let distance = section.number("distance");
    let azimuth = section.number("azimuth");
    let elevation = section.number("elevation");
    let field_of_view = section.number("field_of_view");
    Ok(CameraKeyframe {
        time: f64::from(needed(time)?),
        target: target?.map(Vec3::from),
        eye: eye?.map(Vec3::from),
        distance: distance?,
        azimuth: azimuth?,
        elevation: elevation?,
        field_of_view: field_of_view?,
    })
}

/// Compares a keyframe with the previous one, and its eye with its target.
fn check(
    section: &Section<'_>,
    keyframe: &CameraKeyframe,
    previous: Option<&CameraKeyframe>,
    camera: &Camera,
) -> Part<()> {
    if let Some(previous) = previous.filter(|previous| keyframe.time <= previous.time) {
        // In single precision, in which they were read: its shortest form is the one in the file.
        let (path, time, before) = (section.key_path("time"), keyframe.time as f32, previous.time as f32);
        let message = format!("{path} = {time} s is not after the previous keyframe, {before} s");
        return Err(section.complain("time", message, "", "keyframes must be in order of increasing time"));
    }
    if keyframe.eye.is_none() {
        return Ok(());
    }
    let eye = section.key_path("eye");
    if let Some(key) = ["distance", "azimuth", "elevation"].into_iter().find(|key| section.has(key)) {
        let message = format!("{} is given beside {eye}", section.key_path(key));
        let hint = "the place of the eye determines it: remove one of them";
        return Err(section.complain(key, message, "", hint));
    }
    let Camera { distance, elevation, .. } = keyframe.camera(camera, None);
    if distance < MIN_DISTANCE {
        let message = format!("{eye} is the target, so the camera has no direction");
        let allowed = format!("{MIN_DISTANCE} m or more from the target");
        return Err(section.complain("eye", message, &allowed, "move the eye or the target"));
    }
    if elevation.abs() > MAX_ELEVATION {
        let message = format!("{eye} is {elevation:.1} degrees above the horizon of the target");
        let allowed = format!("-{MAX_ELEVATION} to {MAX_ELEVATION} degrees");
        return Err(section.complain("eye", message, &allowed, "move the eye a little to the side"));
    }
    Ok(())
}

impl CameraPath {
    /// Reads the text of a file with a camera path: sections `[[keyframe]]` as `[[camera.keyframe]]` of a scene with this
    /// `camera`; `file` is for messages.
    ///
    /// # Errors
    /// All problems of the file: text that is not TOML, unknown keys, values out of range, times that do not increase, an
    /// eye at its target.
    pub fn parse(text: &str, file: &str, camera: &Camera) -> Result<Self, SceneErrors> {
        let reader = Reader::new(Source::new(file, text), None);
        let (table, mistakes) = DeTable::parse_recoverable(text);
        let path = super::report_syntax(&reader, &mistakes).and_then(|()| {
            let root = Section::root(&reader, table.get_ref(), &CAMERA_PATH);
            if !root.has("keyframe") {
                let hint = "a path needs at least one, for example time = 0.5 and azimuth = 90";
                return Err(reader.report(SceneProblem::of_file(file, "there is no [[keyframe]]", hint)));
            }
            read_path(&root.sections("keyframe")?, camera)
        });
        let (errors, _) = reader.finish();
        match path {
            Ok(path) if errors.is_empty() => Ok(path),
            _ => Err(SceneErrors { file: file.to_owned(), errors }),
        }
    }
}
