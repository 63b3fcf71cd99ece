//! A triangle mesh in host memory, with its volume and area.

use super::Attribute;
use super::particles::check_count;
use crate::error::IoError;
use crate::topology::{MAX_TRIANGLES, Topology};

/// A triangle mesh with shared vertices. Seen from outside, the vertices of a triangle run counter-clockwise.
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct Mesh {
    /// Vertex positions in m; y is up.
    pub vertices: Vec<[f32; 3]>,
    /// Unit normals, one per vertex, pointing outwards; empty if absent.
    pub normals: Vec<[f32; 3]>,
    /// Velocities of the vertices in m/s, used for motion blur; empty if absent.
    pub velocities: Vec<[f32; 3]>,
    /// Three vertex numbers (from 0) per triangle.
    pub triangles: Vec<[u32; 3]>,
    /// Other attributes of the vertices, in the formats with [`Format::has_attributes`](crate::Format::has_attributes).
    pub attributes: Vec<Attribute>,
}

impl Mesh {
    /// A mesh of vertex positions in m and triangles of vertex numbers, without any attribute.
    #[must_use]
    pub fn new(vertices: Vec<[f32; 3]>, triangles: Vec<[u32; 3]>) -> Self {
        Self { vertices, triangles, ..Self::default() }
    }

    /// Sets the unit normals of the vertices.
    #[must_use]
    pub fn with_normals(self, normals: Vec<[f32; 3]>) -> Self {
        Self { normals, ..self }
    }

    /// Sets the velocities of the vertices, in m/s.
    #[must_use]
    pub fn with_velocities(self, velocities: Vec<[f32; 3]>) -> Self {
        Self { velocities, ..self }
    }

    /// Sets the other attributes of the vertices.
    #[must_use]
    pub fn with_attributes(self, attributes: Vec<Attribute>) -> Self {
        Self { attributes, ..self }
    }

    /// Number of triangles.
    #[must_use]
    pub fn len(&self) -> usize {
        self.triangles.len()
    }

    /// Whether there are no triangles.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.triangles.is_empty()
    }

    /// Checks that normals, velocities and attributes are absent or one per vertex, that every vertex number is in
    /// range, and that the formats can count the vertices and triangles.
    ///
    /// # Errors
    /// [`IoError::Length`], [`IoError::IndexOutOfRange`] with the first such triangle, or [`IoError::TooMany`].
    pub fn check(&self) -> Result<(), IoError> {
        check_count("vertices", self.vertices.len())?;
        check_count("triangles", self.triangles.len())?;
        let expected = self.vertices.len();
        for (attribute, given) in [("normals", self.normals.len()), ("velocities", self.velocities.len())] {
            if given != 0 && given != expected {
                let attribute = attribute.to_owned();
                return Err(IoError::Length { attribute, given, expected, owner: "vertices" });
            }
        }
        self.attributes.iter().try_for_each(|attribute| attribute.check(expected, "vertices"))?;
        for (triangle, corners) in self.triangles.iter().enumerate() {
            for &index in corners {
                if index as usize >= expected {
                    return Err(IoError::IndexOutOfRange { triangle, index, vertices: expected });
                }
            }
        }
        Ok(())
    }

    /// The enclosed volume, in m^3: the sum over the triangles of the signed volumes of their tetrahedra with one
    /// common point, which is the divergence theorem for the field x/3.
    ///
    /// The value is meaningful only for a closed, consistently oriented mesh ([`Mesh::topology`]); it is negative for a
    /// mesh that is inside out. The sum is computed in f64 relative to the first vertex, so that a mesh far from the
    /// origin loses no digits. Triangles with a vertex number out of range are ignored.
    #[must_use]
    pub fn volume(&self) -> f64 {
        let origin = self.vertices.first().copied().unwrap_or_default().map(f64::from);
        let six_fold: f64 =
            self.corners().map(|c| dot(sub(c[0], origin), cross(sub(c[1], origin), sub(c[2], origin)))).sum();
        six_fold / 6.0
    }

    /// The area of all triangles, in m^2. Triangles with a vertex number out of range are ignored.
    #[must_use]
    pub fn area(&self) -> f64 {
        let twice: f64 = self
            .corners()
            .map(|c| {
                let normal = cross(sub(c[1], c[0]), sub(c[2], c[0]));
                dot(normal, normal).sqrt()
            })
            .sum();
        twice / 2.0
    }

    /// How the triangles are connected: closed, manifold, oriented, components, Euler characteristic.
    ///
    /// # Errors
    /// Those of [`Mesh::check`]; [`IoError::TooMany`] beyond 2^32 / 3 triangles.
    pub fn topology(&self) -> Result<Topology, IoError> {
        self.check()?;
        if self.len() > MAX_TRIANGLES {
            return Err(IoError::TooMany { what: "triangles", given: self.len(), limit: MAX_TRIANGLES });
        }
        Ok(Topology::of(self.vertices.len(), &self.triangles))
    }

    /// The corner positions of every triangle whose vertex numbers are in range, in f64.
    fn corners(&self) -> impl Iterator<Item = [[f64; 3]; 3]> + '_ {
        let corner = |index: u32| self.vertices.get(index as usize).map(|v| v.map(f64::from));
        self.triangles.iter().filter_map(move |&[a, b, c]| Some([corner(a)?, corner(b)?, corner(c)?]))
    }
}

pub(crate) fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(crate) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
