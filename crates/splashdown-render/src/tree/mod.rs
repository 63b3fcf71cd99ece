//! Trees of boxes over the triangles of liquid and bodies, through which shaders follow rays.
//!
//! # How it works
//! The host builds a tree for the liquid and one for the bodies (`bvh.rs`), and uploads both with
//! the corners and their normals (`meshes.rs`). `trace.wgsl` finds the nearest triangle on a ray
//! with a stack of nodes; it needs three storage buffers and nothing else that WebGPU does not
//! guarantee.
//!
//! # Why not the other way
//! Bodies in the tree of the liquid would make shadow rays, which only bodies stop, visit the
//! liquid. A tree that is built on the device would avoid the copy of a mesh to the host, but takes
//! a sort and several passes; a run has its meshes on the host anyway.

mod bvh;
mod meshes;

pub use meshes::TracedMeshes;
