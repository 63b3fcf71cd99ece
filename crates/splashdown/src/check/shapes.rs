//! How the meshes of bodies and fluid are interpreted, and the volumes that pistons close.

use glam::Vec3;
use serde::Serialize;

use crate::bodies::{BodyError, mesh_of, owner};
use crate::sample::mesh_title;
use crate::scene::{Motion, Scene, Script};
use crate::solid::{self, RepairReport};

/// Poses of a motion that are tested.
const POSES: u32 = 400;

/// The interpretation of a mesh.
#[derive(Debug, Clone, Serialize)]
#[non_exhaustive]
pub struct Interpretation {
    /// The body or piece of fluid.
    pub owner: String,
    /// The problems of the mesh and the repairs.
    #[serde(flatten)]
    pub report: RepairReport,
    /// The closed volumes next to a piston.
    pub closed_volumes: Vec<Closing>,
}

/// A closed volume between a body that moves along an axis and a side of the domain.
#[derive(Debug, Clone, Serialize)]
#[non_exhaustive]
pub struct Closing {
    /// The side, such as `x_max`.
    pub side: String,
    /// The lower corner at the start, in m.
    pub low: [f32; 3],
    /// The upper corner at the start, in m.
    pub high: [f32; 3],
    /// The volume at the start, in m^3.
    pub volume: f32,
    /// The smallest volume, in m^3.
    pub least: f32,
}

/// The interpretations of the meshes of all bodies and of `fluid.mesh`, in the order of the scene.
///
/// # Errors
/// [`BodyError`] of a mesh that cannot be read.
pub fn interpretations(scene: &Scene) -> Result<Vec<Interpretation>, BodyError> {
    let mut all = Vec::new();
    for body in &scene.bodies {
        let owner = owner("body", &body.name, &body.mesh);
        let mesh = mesh_of(&owner, &body.mesh)?;
        let (repaired, report) = solid::repair(&mesh, body.shell);
        let closed_volumes = match &body.motion {
            Motion::Scripted(script) => {
                let pose = script.pose(0.0);
                let places =
                    repaired.vertices.iter().map(|v| pose.position + pose.orientation * Vec3::from(*v));
                let corners =
                    places.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
                closings(scene, script, corners)
            }
            _ => Vec::new(),
        };
        all.push(Interpretation { owner, report, closed_volumes });
    }
    for (index, filled) in scene.fluid.meshes.iter().enumerate() {
        let owner = mesh_title(index, filled);
        let (_, report) = solid::repair(&mesh_of(&owner, &filled.mesh)?, filled.shell);
        all.push(Interpretation { owner, report, closed_volumes: Vec::new() });
    }
    Ok(all)
}

/// The volumes that a body closes which moves without rotating: it fills the cross-section between four closed sides, so
/// that no fluid passes it, and moves towards a closed side.
pub(super) fn closings(scene: &Scene, script: &Script, (low, high): (Vec3, Vec3)) -> Vec<Closing> {
    let domain = &scene.domain;
    let spacing = scene.fluid.particle_spacing;
    let start = script.pose(0.0);
    let times = (0..=POSES).map(|k| f64::from(scene.duration) * f64::from(k) / f64::from(POSES));
    let poses: Vec<_> = times.map(|time| script.pose(time)).collect();
    if poses.iter().any(|pose| pose.orientation.angle_between(start.orientation) > 1e-3) {
        return Vec::new();
    }
    let mut found = Vec::new();
    for axis in 0..3 {
        let others = [(axis + 1) % 3, (axis + 2) % 3];
        let fills = others.iter().all(|&other| {
            let gaps = [low[other] - domain.min[other], domain.max[other] - high[other]];
            domain.closed[other] == [true; 2] && gaps.iter().all(|&gap| gap < spacing)
        });
        if !fills {
            continue;
        }
        let area: f32 = others.iter().map(|&other| domain.max[other] - domain.min[other]).product();
        let shifts = poses.iter().map(|pose| pose.position[axis] - start.position[axis]);
        let (back, forth) =
            shifts.fold((0.0_f32, 0.0_f32), |(back, forth), shift| (back.min(shift), forth.max(shift)));
        let lengths = [(low[axis] - domain.min[axis], -back), (domain.max[axis] - high[axis], forth)];
        for (side, (length, stroke)) in lengths.into_iter().enumerate() {
            if !domain.closed[axis][side] || stroke < 0.1 * spacing || length <= 0.0 {
                continue;
            }
            let (mut from, mut to) = (domain.min, domain.max);
            if side == 0 {
                to[axis] = low[axis]
            } else {
                from[axis] = high[axis]
            }
            found.push(Closing {
                side: format!("{}_{}", ["x", "y", "z"][axis], ["min", "max"][side]),
                low: from.to_array(),
                high: to.to_array(),
                volume: length * area,
                least: (length - stroke).max(0.0) * area,
            });
        }
    }
    found
}
