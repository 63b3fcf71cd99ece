//! Solids from the host: their triangles with crisp edges, placed in the world.

use std::collections::HashMap;

use glam::{Quat, Vec3};
use wgpu::{Buffer, BufferUsages, Device};

use crate::buffers::upload;
use crate::{BodyBuffers, Draw, RenderError};

/// Edges sharper than this stay sharp: the cosine of 35 degrees.
const CREASE: f32 = 0.82;

/// A solid's triangles, ready to be placed in any number of frames.
#[derive(Clone, Debug)]
pub struct PlacedBody {
    vertices: Vec<Vec3>,
    normals: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    colour: [f32; 3],
}

impl PlacedBody {
    /// A quiet warm grey, linear.
    pub const COLOUR: [f32; 3] = [0.46, 0.43, 0.38];

    /// From a mesh in m, in its own frame, and a linear colour. Faces that meet in less than 35 degrees are
    /// shaded as one round piece.
    ///
    /// # Errors
    /// [`RenderError::Index`] if a triangle names a vertex that does not exist.
    pub fn new(vertices: &[[f32; 3]], triangles: &[[u32; 3]], colour: [f32; 3]) -> Result<Self, RenderError> {
        for (triangle, corners) in triangles.iter().enumerate() {
            if let Some(&vertex) = corners.iter().find(|&&vertex| vertex as usize >= vertices.len()) {
                return Err(RenderError::Index { triangle, vertex, vertices: vertices.len() });
            }
        }
        let corner = |v: u32| Vec3::from(vertices[v as usize]);
        // Twice the area long.
        let faces: Vec<Vec3> =
            triangles.iter().map(|&[a, b, c]| (corner(b) - corner(a)).cross(corner(c) - corner(a))).collect();
        let mut around: Vec<Vec<u32>> = vec![Vec::new(); vertices.len()];
        for (t, triangle) in triangles.iter().enumerate() {
            for &v in triangle {
                around[v as usize].push(t as u32);
            }
        }
        let mut body = Self { vertices: Vec::new(), normals: Vec::new(), triangles: Vec::new(), colour };
        let mut known: HashMap<(u32, [u32; 3]), u32> = HashMap::new();
        for (t, triangle) in triangles.iter().enumerate() {
            let own = faces[t].normalize_or_zero();
            let placed = triangle.map(|v| {
                let smooth = |face: &Vec3| face.normalize_or_zero().dot(own) > CREASE;
                let normal: Vec3 =
                    around[v as usize].iter().map(|&t| faces[t as usize]).filter(|face| smooth(face)).sum();
                let normal = normal.normalize_or(own);
                let key = (v, normal.to_array().map(f32::to_bits));
                *known.entry(key).or_insert_with(|| {
                    body.vertices.push(corner(v));
                    body.normals.push(normal);
                    body.vertices.len() as u32 - 1
                })
            });
            body.triangles.push(placed);
        }
        Ok(body)
    }
}

/// All solids of one frame.
#[derive(Debug)]
pub struct UploadedBodies {
    vertices: Buffer,
    normals: Buffer,
    colours: Buffer,
    indices: Buffer,
    index_count: u32,
}

impl UploadedBodies {
    /// Places solids: each with the position of its origin in m and its rotation as a quaternion (x, y, z, w).
    pub fn new<'a>(
        device: &Device,
        bodies: impl IntoIterator<Item = (&'a PlacedBody, [f32; 3], [f32; 4])>,
    ) -> Self {
        let (mut vertices, mut normals, mut colours, mut indices) = (vec![], vec![], vec![], vec![]);
        for (body, position, rotation) in bodies {
            let (position, rotation) = (Vec3::from(position), Quat::from_array(rotation));
            let first = vertices.len() as u32;
            let placed = body.vertices.iter().map(|&x| (position + rotation * x).extend(1.0).to_array());
            vertices.extend(placed);
            normals.extend(body.normals.iter().map(|&n| (rotation * n).extend(0.0).to_array()));
            let [r, g, b] = body.colour;
            colours.resize(vertices.len(), [r, g, b, 1.0]);
            indices.extend(body.triangles.iter().map(|t| t.map(|v| first + v)));
        }
        Self {
            vertices: upload(device, "bodies' vertices", &vertices, BufferUsages::VERTEX),
            normals: upload(device, "bodies' normals", &normals, BufferUsages::VERTEX),
            colours: upload(device, "bodies' colours", &colours, BufferUsages::VERTEX),
            indices: upload(device, "bodies' indices", &indices, BufferUsages::INDEX),
            index_count: 3 * indices.len() as u32,
        }
    }

    /// The buffers, to be drawn.
    pub fn buffers(&self) -> BodyBuffers<'_> {
        BodyBuffers {
            vertices: &self.vertices,
            normals: &self.normals,
            colours: &self.colours,
            indices: &self.indices,
            draw: Draw::Direct { index_count: self.index_count },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sharp_edges_are_split_and_gentle_ones_are_not() {
        // A roof: two rectangles that meet along x, first steep, then flat.
        let roof = |height: f32| {
            let vertices = [
                [0.0, 0.0, -1.0],
                [1.0, 0.0, -1.0],
                [0.0, height, 0.0],
                [1.0, height, 0.0],
                [0.0, 0.0, 1.0],
                [1.0, 0.0, 1.0],
            ];
            let triangles = [[0, 2, 1], [1, 2, 3], [2, 4, 3], [3, 4, 5]];
            PlacedBody::new(&vertices, &triangles, PlacedBody::COLOUR).unwrap().vertices.len()
        };
        assert_eq!(roof(1.0), 8);
        assert_eq!(roof(0.1), 6);
        assert!(PlacedBody::new(&[[0.0; 3]], &[[0, 0, 1]], PlacedBody::COLOUR).is_err());
    }
}
