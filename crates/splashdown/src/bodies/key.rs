//! Fingerprints of bodies, by which a checkpoint identifies them.

use serde::{Deserialize, Serialize};

use super::BodyMesh;
use crate::fingerprint::hash;

/// The fingerprint of a body's repaired mesh.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct BodyKey {
    pub name: String,
    pub vertices: usize,
    pub triangles: usize,
    /// Volume of the repaired mesh in m^3.
    pub volume: f32,
    /// Hash of its vertices and triangles.
    pub hash: u64,
}

impl std::fmt::Display for BodyKey {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { vertices, triangles, volume, hash, .. } = self;
        write!(f, "{vertices} vertices, {triangles} triangles, {volume:.4e} m^3 and the hash {hash:016x}")
    }
}

impl BodyKey {
    /// The fingerprint of a body.
    pub fn new(BodyMesh { name, mesh, .. }: &BodyMesh) -> Self {
        Self {
            name: name.clone(),
            vertices: mesh.vertices.len(),
            triangles: mesh.triangles.len(),
            volume: mesh.volume() as f32,
            hash: hash(bytemuck::cast_slice(&mesh.vertices))
                ^ hash(bytemuck::cast_slice(&mesh.triangles)).rotate_left(1),
        }
    }
}

/// A difference between the bodies of a scene and those of a checkpoint.
#[derive(Clone, Debug)]
pub(crate) enum BodiesChanged {
    /// A body has another mesh.
    Mesh {
        /// The body now.
        now: BodyKey,
        /// The body in the checkpoint.
        then: BodyKey,
    },
    /// The numbers of bodies differ.
    Count {
        /// Bodies of the scene.
        now: usize,
        /// Bodies in the checkpoint.
        then: usize,
    },
}
