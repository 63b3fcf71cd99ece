//! The meshes of bodies at their poses at the start.

use std::cell::OnceCell;

use glam::Vec3;
use splashdown_io::Mesh;

use crate::scene::{Body, Motion};
use crate::solid::{self, Bvh};

/// A point is inside a mesh if the absolute winding number exceeds this value; on the surface it is 0.5.
const INSIDE: f32 = 0.75;
/// Points of a triangle: its middle, and this part of the way from there to its corners.
const TO_CORNERS: f32 = 0.9;

/// A body's mesh at its pose at t = 0.
pub(super) struct Placed<'a> {
    pub body: &'a Body,
    pub low: Vec3,
    pub high: Vec3,
    mesh: Mesh,
    /// The volume of a solid; `None` for a shell, which encloses none. Repaired when it is first needed.
    volume: OnceCell<Option<Volume>>,
}

/// The inside of a solid.
struct Volume {
    /// Oriented outwards.
    triangles: Vec<[Vec3; 3]>,
    tree: Bvh,
}

impl<'a> Placed<'a> {
    pub fn new(body: &'a Body, mesh: &Mesh) -> Self {
        let (position, rotation) = match &body.motion {
            Motion::Scripted(script) => {
                let pose = script.pose(0.0);
                (pose.position, pose.orientation)
            }
            _ => (body.mesh.position, body.mesh.rotation),
        };
        let vertices: Vec<[f32; 3]> =
            mesh.vertices.iter().map(|v| (position + rotation * Vec3::from(*v)).to_array()).collect();
        // A mesh with missing vertices is refused when it is built.
        let is_whole = |t: &&[u32; 3]| t.iter().all(|&v| (v as usize) < vertices.len());
        let triangles = mesh.triangles.iter().filter(is_whole).copied().collect();
        let mesh = Mesh::new(vertices, triangles);
        let (low, high) = solid::bounds(&mesh);
        Self { body, low, high, mesh, volume: OnceCell::new() }
    }

    /// Whether a point lies in the body. No point lies in a shell.
    pub fn contains(&self, x: Vec3) -> bool {
        let is_near = x.cmpge(self.low).all() && x.cmple(self.high).all();
        is_near && self.volume().is_some_and(|volume| volume.tree.winding(x).abs() > INSIDE)
    }

    /// Points of the body in this box, `depth` m below its surface; none of a shell.
    pub fn points_in(&self, low: Vec3, high: Vec3, depth: f32) -> Vec<Vec3> {
        let triangles = self.volume().map_or(&[][..], |volume| &volume.triangles);
        let of_triangle = |&[a, b, c]: &[Vec3; 3]| {
            let middle = (a + b + c) / 3.0;
            let inwards = -depth * (b - a).cross(c - a).normalize_or_zero();
            [a, b, c, middle].map(|corner| middle.lerp(corner, TO_CORNERS) + inwards)
        };
        let is_in = |x: &Vec3| x.cmpge(low).all() && x.cmple(high).all();
        triangles.iter().flat_map(of_triangle).filter(is_in).collect()
    }

    fn volume(&self) -> Option<&Volume> {
        let build = || {
            let (mesh, report) = solid::repair(&self.mesh, self.body.shell);
            let corner = |v: u32| Vec3::from(mesh.vertices[v as usize]);
            let triangles: Vec<_> = mesh.triangles.iter().map(|t| t.map(corner)).collect();
            let is_solid = !report.shell && !triangles.is_empty();
            is_solid.then(|| Volume { tree: Bvh::new(triangles.clone()), triangles })
        };
        self.volume.get_or_init(build).as_ref()
    }
}
