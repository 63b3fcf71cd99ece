//! Animated scenes: all frames of a run in one file, with the fluid, bodies, the tank, a camera and materials.
//!
//! A [`Stage`] describes what the scene contains. A [`StageFile`](crate::StageFile) collects the frames and writes the
//! files.

mod spool;

use std::sync::Arc;

pub(crate) use spool::{Blocks, Channel, Found, Signature, Spool};

use crate::data::{Mesh, Particles};

/// What an animated scene contains. All lengths are in m.
#[derive(Debug, Clone, PartialEq)]
pub struct Stage {
    /// Frames per second of simulated time.
    pub frames_per_second: f64,
    /// The direction that is up: that against gravity. Only its dominant axis counts.
    pub up: [f32; 3],
    /// The parts of the scene. Their names are made valid and unique by each format.
    pub objects: Vec<Object>,
    /// The materials of the objects.
    pub materials: Vec<(String, Material)>,
}

impl Stage {
    /// Only a surface, for a mesh that changes from frame to frame.
    #[must_use]
    pub fn of_surface(frames_per_second: f64) -> Self {
        Self::of_one("surface", Shape::Surface, frames_per_second)
    }

    /// Only particles, shown as spheres of this diameter in m.
    #[must_use]
    pub fn of_particles(frames_per_second: f64, diameter: f32) -> Self {
        Self::of_one("particles", Shape::Points { diameter }, frames_per_second)
    }

    fn of_one(name: &str, shape: Shape, frames_per_second: f64) -> Self {
        let water = Material::Liquid {
            absorption: [0.264, 0.0565, 0.0101],
            scattering: 0.0,
            colour: [0.2, 0.45, 0.6],
            refractive_index: 1.333,
        };
        let object = Object { name: name.to_owned(), shape, pose: Pose::IDENTITY, material: Some(0) };
        Self {
            frames_per_second,
            up: [0.0, 1.0, 0.0],
            objects: vec![object],
            materials: vec![("water".to_owned(), water)],
        }
    }
}

/// A part of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Object {
    /// Its name.
    pub name: String,
    /// What it is.
    pub shape: Shape,
    /// Its place where its frames have no place of their own.
    pub pose: Pose,
    /// Number of its material in [`Stage::materials`].
    pub material: Option<usize>,
}

/// What an object is.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// A mesh that differs in every frame: each has a [`Sample::Mesh`].
    Surface,
    /// Spheres of this diameter; each frame has a [`Sample::Points`].
    Points {
        /// Diameter in m.
        diameter: f32,
    },
    /// A constant mesh. It moves where its frames have a [`Sample::Pose`].
    Solid(Arc<Mesh>),
    /// A perspective camera that looks along its -z axis, with +y up in the picture.
    Camera {
        /// Vertical angle of view in degrees.
        field_of_view: f32,
        /// Width over height of the picture.
        aspect: f32,
        /// Distance of sharp things in m.
        focus: f32,
    },
}

/// A place: the rotation, followed by the translation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// The position of the object's origin in m.
    pub position: [f32; 3],
    /// The rotation as a unit quaternion x, y, z, w.
    pub orientation: [f32; 4],
}

impl Pose {
    /// At the origin, not rotated.
    pub const IDENTITY: Self = Self { position: [0.0; 3], orientation: [0.0, 0.0, 0.0, 1.0] };
}

/// How an object looks. Colours are linear RGB.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Material {
    /// A transparent or turbid liquid.
    Liquid {
        /// Absorption of red, green and blue in 1/m (Beer-Lambert).
        absorption: [f32; 3],
        /// Rate in 1/m at which `colour` replaces what is behind the liquid.
        scattering: f32,
        /// The liquid's own colour.
        colour: [f32; 3],
        /// Refractive index.
        refractive_index: f32,
    },
    /// A diffuse surface.
    Opaque {
        /// Its colour.
        colour: [f32; 3],
    },
    /// Thin clear panes.
    Panes,
}

impl Material {
    /// The share of light that passes a decimetre of the material without being scattered, from 0 to 1.
    pub(crate) fn clarity(&self) -> f32 {
        match self {
            Self::Liquid { scattering, .. } => (-0.1 * scattering).exp(),
            Self::Opaque { .. } => 0.0,
            Self::Panes => 1.0,
        }
    }

    /// The colour that it shows: that of the light that is left at the depth where half of it is absorbed on average.
    pub(crate) fn colour(&self) -> [f32; 3] {
        match *self {
            Self::Liquid { absorption, colour, .. } => {
                let clear = self.clarity();
                let depth = 1.5 / absorption.iter().sum::<f32>().max(1e-6);
                std::array::from_fn(|n| clear * (-absorption[n] * depth).exp() + (1.0 - clear) * colour[n])
            }
            Self::Opaque { colour } => colour,
            Self::Panes => [0.9; 3],
        }
    }
}

/// The data of an object in a frame.
#[derive(Debug, Clone, PartialEq)]
pub enum Sample {
    /// The mesh of a [`Shape::Surface`].
    Mesh(Arc<Mesh>),
    /// The particles of [`Shape::Points`].
    Points(Arc<Particles>),
    /// The place of a body or camera.
    Pose(Pose),
    /// The place of a camera, and its lens.
    View {
        /// The place.
        pose: Pose,
        /// Vertical angle of view in degrees.
        field_of_view: f32,
        /// Distance of sharp things in m.
        focus: f32,
    },
}

/// How the axes of a scene are turned so that a file has its up direction along one of its axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Up {
    PlusY,
    PlusZ,
    /// Another axis; this rotation (x, y, z, w) turns it to +y.
    Turned([f32; 4]),
}

impl Up {
    /// By the dominant axis of a direction; +y without one.
    pub(crate) fn of(direction: [f32; 3]) -> Self {
        let largest = direction.iter().fold(0.0_f32, |largest, value| largest.max(value.abs()));
        let is = |axis: usize, sign: f32| largest > 0.0 && direction[axis] * sign >= largest;
        let half = std::f32::consts::FRAC_1_SQRT_2;
        match () {
            () if is(1, 1.0) => Self::PlusY,
            () if is(2, 1.0) => Self::PlusZ,
            () if is(0, 1.0) => Self::Turned([0.0, 0.0, half, half]),
            () if is(0, -1.0) => Self::Turned([0.0, 0.0, -half, half]),
            () if is(2, -1.0) => Self::Turned([half, 0.0, 0.0, half]),
            () if is(1, -1.0) => Self::Turned([1.0, 0.0, 0.0, 0.0]),
            () => Self::PlusY,
        }
    }
}

/// The lower and upper corner of the bounding box of all finite points; the origin if there are none.
pub(crate) fn extent(points: &[[f32; 3]]) -> [[f32; 3]; 2] {
    let mut finite = points.iter().filter(|point| point.iter().all(|component| component.is_finite()));
    let Some(&first) = finite.next() else { return [[0.0; 3]; 2] };
    finite.fold([first, first], |[low, high], point| {
        [
            std::array::from_fn(|axis| low[axis].min(point[axis])),
            std::array::from_fn(|axis| high[axis].max(point[axis])),
        ]
    })
}

/// Valid and unique names: letters, digits and underscores of ASCII, not beginning with a digit.
pub(crate) fn identifiers<'a>(names: impl Iterator<Item = &'a str>) -> Vec<String> {
    let mut given: Vec<String> = Vec::new();
    for name in names {
        let mut word: String =
            name.chars().map(|letter| if letter.is_ascii_alphanumeric() { letter } else { '_' }).collect();
        if word.is_empty() || word.starts_with(|letter: char| letter.is_ascii_digit()) {
            word.insert(0, '_');
        }
        let numbered = (2..).map(|number| format!("{word}_{number}"));
        let free = std::iter::once(word.clone()).chain(numbered).find(|word| !given.contains(word));
        given.extend(free);
    }
    given
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_become_identifiers() {
        let names = ["ball", "ball", "2 Räder", "", "a-b"];
        assert_eq!(identifiers(names.into_iter()), ["ball", "ball_2", "_2_R_der", "_", "a_b"]);
    }

    /// The rotation of a vector by a quaternion.
    fn turned([x, y, z, w]: [f32; 4], v: [f32; 3]) -> [f32; 3] {
        let cross = |a: [f32; 3], b: [f32; 3]| {
            [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
        };
        let u = [x, y, z];
        let t = cross(u, v).map(|component| 2.0 * component);
        let last = cross(u, t);
        std::array::from_fn(|n| v[n] + w * t[n] + last[n])
    }

    #[test]
    fn every_axis_is_turned_up() {
        assert_eq!([Up::of([0.0, 9.8, 0.1]), Up::of([0.0; 3])], [Up::PlusY; 2]);
        assert_eq!(Up::of([-1.0, 2.0, 9.0]), Up::PlusZ);
        for axis in [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]] {
            let Up::Turned(rotation) = Up::of(axis) else { panic!("{axis:?} is not turned") };
            let up = turned(rotation, axis);
            assert!((up[1] - 1.0).abs() < 1e-6, "{axis:?} becomes {up:?}");
        }
    }

    #[test]
    fn clear_and_turbid_liquids_differ() {
        let liquid = |scattering| Material::Liquid {
            absorption: [2.0, 0.0, 0.0],
            scattering,
            colour: [0.9; 3],
            refractive_index: 1.333,
        };
        let [clear, milk] = [liquid(0.0), liquid(3000.0)];
        assert_eq!([clear.clarity(), milk.clarity()], [1.0, 0.0]);
        assert_eq!(clear.colour(), [(-1.5_f32).exp(), 1.0, 1.0]);
        assert_eq!(milk.colour(), [0.9; 3]);
    }
}
