//! Meshes of bodies, with sharp edges preserved, and their upload.

use std::collections::HashMap;

use glam::{Quat, Vec3};
use wgpu::{Buffer, BufferUsages, Device};

use crate::uploads::{check_indices, upload};
use crate::{BodyBuffers, Draw, RenderError};

/// Cosine of the crease angle, 35 degrees. Edges with a larger angle between their faces remain
/// sharp.
const CREASE: f32 = 0.82;

/// The mesh of a body in its own frame. It is prepared once and can be drawn in any number of
/// pictures.
#[derive(Clone, Debug)]
pub struct PlacedBody {
    vertices: Vec<Vec3>,
    normals: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    colour: [f32; 3],
}

impl PlacedBody {
    /// The default colour, a warm grey (linear RGB).
    pub const COLOUR: [f32; 3] = [0.46, 0.43, 0.38];

    /// Prepares a mesh (metres, in the frame of the body) with a linear RGB colour. Faces whose
    /// normals differ by less than 35 degrees get smooth shading.
    ///
    /// # Errors
    /// [`RenderError::Index`] if a triangle refers to a vertex that does not exist.
    pub fn new(vertices: &[[f32; 3]], triangles: &[[u32; 3]], colour: [f32; 3]) -> Result<Self, RenderError> {
        check_indices(triangles, vertices.len())?;
        let corner = |v: u32| Vec3::from(vertices[v as usize]);
        // The length is twice the area, which weights the averages below.
        let faces: Vec<Vec3> =
            triangles.iter().map(|&[a, b, c]| (corner(b) - corner(a)).cross(corner(c) - corner(a))).collect();
        let mut adjacent: Vec<Vec<u32>> = vec![Vec::new(); vertices.len()];
        for (t, triangle) in triangles.iter().enumerate() {
            for &v in triangle {
                adjacent[v as usize].push(t as u32);
            }
        }
        let mut body = Self { vertices: Vec::new(), normals: Vec::new(), triangles: Vec::new(), colour };
        let mut known: HashMap<(u32, [u32; 3]), u32> = HashMap::new();
        for (t, triangle) in triangles.iter().enumerate() {
            let own = faces[t].normalize_or_zero();
            let placed = triangle.map(|v| {
                let smooth = |face: &Vec3| face.normalize_or_zero().dot(own) > CREASE;
                let normal: Vec3 =
                    adjacent[v as usize].iter().map(|&t| faces[t as usize]).filter(|face| smooth(face)).sum();
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

    /// Vertices and normals at a position (m) with a rotation (quaternion x, y, z, w).
    pub(crate) fn placed(
        &self,
        position: [f32; 3],
        rotation: [f32; 4],
    ) -> impl Iterator<Item = (Vec3, Vec3)> {
        let (position, rotation) = (Vec3::from(position), Quat::from_array(rotation));
        let pairs = self.vertices.iter().zip(&self.normals);
        pairs.map(move |(&x, &n)| (position + rotation * x, rotation * n))
    }

    /// Three vertices each.
    pub(crate) fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Linear RGB.
    pub(crate) fn colour(&self) -> [f32; 3] {
        self.colour
    }
}

/// All bodies of one frame.
#[derive(Debug)]
pub struct UploadedBodies {
    vertices: Buffer,
    normals: Buffer,
    colours: Buffer,
    indices: Buffer,
    index_count: u32,
}

impl UploadedBodies {
    /// Uploads bodies, each with the position of its origin in metres and its rotation as a
    /// quaternion (x, y, z, w).
    pub fn new<'a>(
        device: &Device,
        bodies: impl IntoIterator<Item = (&'a PlacedBody, [f32; 3], [f32; 4])>,
    ) -> Self {
        let (mut vertices, mut normals, mut colours, mut indices) = (vec![], vec![], vec![], vec![]);
        for (body, position, rotation) in bodies {
            let first = vertices.len() as u32;
            for (x, n) in body.placed(position, rotation) {
                vertices.push(x.extend(1.0).to_array());
                normals.push(n.extend(0.0).to_array());
            }
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

    /// The buffers, for [`Frame::bodies`](crate::Frame::bodies).
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
    fn sharp_edges_are_split_and_smooth_edges_are_not() {
        // A roof of two rectangles that share an edge along x, first steep, then flat.
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
