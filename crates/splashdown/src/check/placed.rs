//! The meshes of bodies at their poses at the start.

use glam::Vec3;
use splashdown_io::Mesh;

use crate::scene::{Body, Motion};
use crate::solid;

/// A point is inside a mesh if the absolute winding number exceeds this value; on the surface it is 0.5.
const INSIDE: f64 = 0.75;

/// A body's mesh at its pose at t = 0.
pub(super) struct Placed<'a> {
    pub body: &'a Body,
    triangles: Vec<[Vec3; 3]>,
    pub low: Vec3,
    pub high: Vec3,
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
        let vertices: Vec<Vec3> =
            mesh.vertices.iter().map(|v| position + rotation * Vec3::from(*v)).collect();
        let corner = |v: u32| vertices.get(v as usize).copied().unwrap_or(Vec3::ZERO);
        let (low, high) = vertices
            .iter()
            .fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), x| (low.min(*x), high.max(*x)));
        Self { body, triangles: mesh.triangles.iter().map(|t| t.map(corner)).collect(), low, high }
    }

    /// The number of triangles.
    pub fn triangle_count(&self) -> usize {
        self.triangles.len()
    }

    /// At most `most` corners and middles of triangles, moved towards the middle of the body by `inwards` m.
    pub fn points(&self, inwards: f32, most: usize) -> impl Iterator<Item = Vec3> {
        let middle = 0.5 * (self.low + self.high);
        let every = (4 * self.triangles.len()).div_ceil(most.max(1)).max(1);
        let points = self.triangles.iter().flat_map(|[a, b, c]| [*a, *b, *c, (*a + *b + *c) / 3.0]);
        points.step_by(every).map(move |point| {
            let way = middle - point;
            point + way.clamp_length_max(inwards)
        })
    }

    /// Whether a point lies inside the mesh, for either orientation of its triangles.
    pub fn contains(&self, x: Vec3) -> bool {
        if x.cmplt(self.low).any() || x.cmpgt(self.high).any() {
            return false;
        }
        solid::winding(&self.triangles, x).abs() > INSIDE
    }
}
