//! The fluid's surface: from particles to a closed triangle mesh, on the device or on the CPU.
//!
//! # How it works
//!
//! 1. `volume`: each particle's share of space and how crowded it is.
//! 2. `blocks`: the blocks of 8x8x8 nodes that particles reach, marked, numbered by a scan, listed.
//! 3. `field`: the colour field at the nodes of these blocks, and its signs.
//! 4. `march`: cut edges counted, numbered by scans, turned into shared vertices with normals and into
//!    triangles (marching cubes: Lorensen and Cline 1987). The arguments of the indirect draw are written on
//!    the device.
//! 5. `smooth`: weighted Laplacian smoothing (Löschner et al. 2023), where asked for.
//!
//! The mesh is closed, manifold and oriented outwards for any set of particles: which vertices exist and how
//! triangles join them follows from the nodes' signs alone (see [`marching_cubes`](crate::marching_cubes)), each node's sign is computed
//! once, and the nodes at the rim of the marked blocks are outside. The same particles give the same bits on
//! the same device, with any number of threads.
//!
//! # Measured
//!
//! 64,000 particles in mid-splash, 2 cores with AVX2, medians; `splashsurf_lib` 0.14.1 in the same run and
//! with the same parameters finds the same number of vertices:
//!
//! | cells, in spacings | smoothing | vertices | CPU | software Vulkan | splashsurf, not smoothed |
//! |---|---|---|---|---|---|
//! | 0.5 | none | 57,272 | 25 ms | 110 ms | 79 ms |
//! | 0.5 | 25 rounds | 57,272 | 42 ms | 156 ms | 81 ms |
//! | 0.25 | none | 231,858 | 92 ms | 533 ms | 245 ms |
//!
//! These are the passes alone; with [`reconstruct`]'s sorting and copying see `examples/surface_times.rs`,
//! which prints both. Two thirds are the field's square roots.
//!
//! # Why not the other way
//!
//! A dense grid costs memory by the domain's volume instead of the fluid's. A hash table of edges, the usual
//! way to share vertices, needs atomics and gives another order every time; numbers from scans need neither.
//! Dual contouring places vertices at creases, which water does not have, and can give edges with four
//! triangles.

mod blobs;
mod blocks;
mod error;
mod field;
mod gather;
mod interpolate;
mod march;
mod mesh;
mod modules;
mod params;
mod parts;
mod reconstruct;
mod smooth;
mod spline;
#[cfg(test)]
mod tests;
mod volume;

pub use blobs::drop_blobs;
pub use error::SurfaceError;
pub use interpolate::interpolate;
pub(crate) use mesh::forecast;
pub use mesh::{Surface, SurfaceInput, SurfaceStats};
pub use params::{Status, SurfaceParams};
pub use reconstruct::reconstruct;

use splashdown_gpu::PassDesc;

/// Every pass of the surface, for the gate and the tests.
pub fn passes() -> Vec<&'static PassDesc> {
    vec![
        &volume::VOLUME,
        &blocks::MARK,
        &blocks::COMPACT,
        &blocks::PLAN,
        &field::FIELD,
        &march::COUNT,
        &march::FINISH,
        &march::VERTICES,
        &march::TRIANGLES,
        &smooth::WEIGH,
        &smooth::VALENCE,
        &smooth::RING,
        &smooth::ORDER,
        &smooth::RELAX,
        &smooth::SHADE,
    ]
}
