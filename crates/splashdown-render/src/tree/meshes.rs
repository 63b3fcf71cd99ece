//! The triangles of liquid and bodies on the device, with their trees.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;
use wgpu::{Buffer, BufferUsages, Device};

use super::bvh::{self, Node};
use crate::uploads::{area_weighted_normals, check_indices, check_length, upload};
use crate::{PlacedBody, RenderError};

/// In place of the root of an empty tree.
const NO_TREE: u32 = u32::MAX;

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
struct Corner {
    position: [f32; 3],
    /// Two 16-bit numbers, see [`packed`].
    normal: u32,
}

/// The meshes of a frame, prepared for tracing rays: [`Frame::with_tracing`](crate::Frame::with_tracing).
///
/// A host builds the trees; 300,000 triangles take about 0.15 s on one core.
#[derive(Debug)]
pub struct TracedMeshes {
    nodes: Buffer,
    triangles: Buffer,
    corners: Buffer,
    water_root: u32,
    body_root: u32,
    /// The corners of the box around the liquid; the lower one is the greater one without liquid.
    water_bounds: [Vec3; 2],
    /// Of the lowest and the highest point of all bodies.
    body_heights: [f32; 2],
}

/// Triangles and corners while they are collected.
#[derive(Default)]
struct Triangles {
    corners: Vec<Corner>,
    nodes: Vec<Node>,
    /// Three corners and a colour.
    triangles: Vec<[u32; 4]>,
}

impl TracedMeshes {
    /// Builds the trees of a liquid and of bodies, each with the position of its origin in metres
    /// and its rotation as a quaternion (x, y, z, w).
    ///
    /// The liquid is a closed mesh, counterclockwise as seen from outside, in metres. If `normals`
    /// is empty, those of the triangles are averaged.
    ///
    /// # Errors
    /// [`RenderError::Length`] if there are normals, but not one per vertex; [`RenderError::Index`]
    /// if a triangle refers to a vertex that does not exist; [`RenderError::TooManyTriangles`].
    pub fn new<'a>(
        device: &Device,
        vertices: &[[f32; 3]],
        normals: &[[f32; 3]],
        triangles: &[[u32; 3]],
        bodies: impl IntoIterator<Item = (&'a PlacedBody, [f32; 3], [f32; 4])>,
    ) -> Result<TracedMeshes, RenderError> {
        check_length("normals", normals.len(), vertices.len())?;
        check_indices(triangles, vertices.len())?;
        let mut all = Triangles::default();
        let averaged;
        let normals: &[[f32; 3]] = if normals.is_empty() {
            averaged = area_weighted_normals(vertices, triangles)
                .iter()
                .map(|&[x, y, z, _]| [x, y, z])
                .collect::<Vec<_>>();
            &averaged
        } else {
            normals
        };
        let corners = vertices.iter().zip(normals);
        all.corners = corners.map(|(&position, &n)| Corner { position, normal: packed(n.into()) }).collect();
        let rows: Vec<[u32; 4]> = triangles.iter().map(|&[a, b, c]| [a, b, c, 0]).collect();
        let water_root = all.add_tree(&rows);
        let mut rows = Vec::new();
        let first_of_bodies = all.corners.len();
        for (body, position, rotation) in bodies {
            let first = all.corners.len() as u32;
            let places = body.placed(position, rotation);
            all.corners.extend(places.map(|(x, n)| Corner { position: x.into(), normal: packed(n) }));
            let colour = packed_colour(body.colour());
            rows.extend(body.triangles().iter().map(|t| {
                let [a, b, c] = t.map(|v| first + v);
                [a, b, c, colour]
            }));
        }
        let body_root = all.add_tree(&rows);
        let heights = || all.corners[first_of_bodies..].iter().map(|corner| corner.position[1]);
        let body_heights = match rows.is_empty() {
            true => [0.0; 2],
            false => [heights().fold(f32::INFINITY, f32::min), heights().fold(f32::NEG_INFINITY, f32::max)],
        };
        let points = || vertices.iter().map(|&vertex| Vec3::from(vertex));
        let water_bounds =
            [points().fold(Vec3::INFINITY, Vec3::min), points().fold(Vec3::NEG_INFINITY, Vec3::max)];
        all.upload(device, [water_root, body_root], water_bounds, body_heights)
    }
}

impl TracedMeshes {
    /// The roots of the trees of liquid and bodies, as in the uniforms.
    pub(crate) fn roots(&self) -> (u32, u32) {
        (self.water_root, self.body_root)
    }

    /// The corners of the box around the liquid; without liquid, no point is between them.
    pub(crate) fn water_bounds(&self) -> [Vec3; 2] {
        self.water_bounds
    }

    /// Heights of the lowest and the highest point of all bodies.
    pub(crate) fn body_heights(&self) -> [f32; 2] {
        self.body_heights
    }

    pub(crate) fn has_bodies(&self) -> bool {
        self.body_root != NO_TREE
    }

    /// Nodes, triangles and corners, in the order of the bindings of `trace.wgsl`.
    pub(crate) fn buffers(&self) -> [&Buffer; 3] {
        [&self.nodes, &self.triangles, &self.corners]
    }
}

impl Triangles {
    /// Appends triangles and their tree; returns its root.
    fn add_tree(&mut self, rows: &[[u32; 4]]) -> u32 {
        if rows.is_empty() {
            return NO_TREE;
        }
        let corner = |v: u32| Vec3::from(self.corners[v as usize].position);
        let (nodes, order) = bvh::build(rows.iter().map(|&[a, b, c, _]| [a, b, c].map(corner)));
        let (root, first) = (self.nodes.len() as u32, self.triangles.len() as u32);
        self.nodes.extend(nodes.into_iter().map(|node| node.moved(root, first)));
        self.triangles.extend(order.into_iter().map(|index| rows[index as usize]));
        root
    }

    fn upload(
        self,
        device: &Device,
        [water_root, body_root]: [u32; 2],
        water_bounds: [Vec3; 2],
        body_heights: [f32; 2],
    ) -> Result<TracedMeshes, RenderError> {
        let limits = device.limits();
        let limit = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size);
        let largest =
            [size_of_val(&self.nodes[..]), size_of_val(&self.triangles[..]), size_of_val(&self.corners[..])];
        let largest = largest.into_iter().max().unwrap_or(0) as u64;
        let given = self.triangles.len();
        if largest > limit || given > bvh::MAX_TRIANGLES {
            let allowed = (given as f64 * (limit as f64 / largest as f64).min(1.0)) as usize;
            return Err(RenderError::TooManyTriangles { given, allowed: allowed.min(bvh::MAX_TRIANGLES) });
        }
        let usage = BufferUsages::STORAGE;
        Ok(TracedMeshes {
            nodes: upload(device, "tree nodes", &self.nodes, usage),
            triangles: upload(device, "tree triangles", &self.triangles, usage),
            corners: upload(device, "tree corners", &self.corners, usage),
            water_root,
            body_root,
            water_bounds,
            body_heights,
        })
    }
}

/// A direction as two 16-bit numbers: its place on an octahedron (Cigolle et al., "A survey of
/// efficient representations for independent unit vectors", 2014).
fn packed(normal: Vec3) -> u32 {
    let n = normal / normal.abs().element_sum().max(1e-20);
    let sign = |x: f32| if x >= 0.0 { 1.0 } else { -1.0 };
    let (x, y) = match n.z >= 0.0 {
        true => (n.x, n.y),
        false => ((1.0 - n.y.abs()) * sign(n.x), (1.0 - n.x.abs()) * sign(n.y)),
    };
    let [x, y] = [x, y].map(|value| u32::from((value.clamp(-1.0, 1.0) * 32767.0).round() as i16 as u16));
    x | y << 16
}

/// Square roots of the components in eight bits each; never 0, which stands for liquid.
fn packed_colour(colour: [f32; 3]) -> u32 {
    let bytes = colour.map(|value| (value.clamp(0.0, 1.0).sqrt() * 255.0).round() as u32);
    0xff00_0000 | bytes[2] << 16 | bytes[1] << 8 | bytes[0]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As `unpacked_normal` in trace.wgsl.
    fn unpacked(packed: u32) -> Vec3 {
        let half = |bits: u32| f32::from(bits as u16 as i16) / 32767.0;
        let (x, y) = (half(packed & 0xffff), half(packed >> 16));
        let mut n = Vec3::new(x, y, 1.0 - x.abs() - y.abs());
        let fold = (-n.z).max(0.0);
        n.x += if n.x >= 0.0 { -fold } else { fold };
        n.y += if n.y >= 0.0 { -fold } else { fold };
        n.normalize_or_zero()
    }

    #[test]
    fn normals_survive_packing() {
        for i in 0..500 {
            let (t, z) = (2.4 * i as f32, 1.0 - (2 * i + 1) as f32 / 500.0);
            let r = (1.0 - z * z).sqrt();
            let normal = Vec3::new(r * t.cos(), r * t.sin(), z);
            assert!(unpacked(packed(normal)).distance(normal) < 1e-4, "{normal}");
            // Negative control: the opposite direction.
            assert!(unpacked(packed(-normal)).distance(normal) > 1.9);
        }
    }

    #[test]
    fn trees_of_liquid_and_bodies_share_buffers() {
        let square = [[0, 1, 2, 0], [0, 2, 3, 0]];
        let corner = |x: f32, y: f32| Corner { position: [x, y, 0.0], normal: 0 };
        let corners = vec![corner(0.0, 0.0), corner(1.0, 0.0), corner(1.0, 1.0), corner(0.0, 1.0)];
        let mut all = Triangles { corners, ..Triangles::default() };
        assert_eq!(all.add_tree(&[]), NO_TREE);
        assert_eq!(all.add_tree(&square), 0);
        let body = square.map(|[a, b, c, _]| [a, b, c, 7]);
        assert_eq!(all.add_tree(&body), 1);
        // The leaf of the second tree begins after the triangles of the first.
        assert_eq!(all.nodes[1].children[0].content & 0xfff_ffff, 2);
        assert_eq!(all.triangles[2][3], 7);
    }
}
