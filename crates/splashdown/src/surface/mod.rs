//! Surface reconstruction: from particles to a closed triangle mesh, on the device or on the CPU.
//!
//! # How it works
//!
//! Closed sides of the domain are planes of symmetry of the field, and the mesh ends there: see
//! `walls`.
//!
//! 1. `droplets`: isolated particles leave the surface, if requested.
//! 2. `volume`: the volume and the local density of each particle; or `anisotropy`, the ellipsoids of
//!    the anisotropic field.
//! 3. `blocks`: the blocks of 8x8x8 nodes within reach of particles are marked, numbered by a scan,
//!    and listed.
//! 4. `field`: the colour field and its signs at the nodes of these blocks; `solids`: the field ends at bodies.
//! 5. `march`: cut edges are counted, numbered by scans, and converted into shared vertices with
//!    normals and into triangles (marching cubes: Lorensen and Cline 1987). The arguments of the
//!    indirect draw are written on the device.
//! 6. `smooth`: weighted Laplacian smoothing (Löschner et al. 2023), optional.
//!
//! The mesh is closed, manifold and oriented outwards for any set of particles: vertices and
//! connectivity follow from the signs of the nodes alone (see
//! `marching_cubes`), the sign of each node is computed once, and the
//! nodes at the border of the marked blocks are outside. On the same device, the same particles
//! give bit-identical meshes for any number of threads.
//!
//! # Measured
//!
//! 64,000 particles of a splash, 2 cores with AVX2, medians. `splashsurf_lib` 0.14.1, in the same
//! run with the same parameters, produces the same number of vertices:
//!
//! | cells, in spacings | smoothing | vertices | CPU | software Vulkan | splashsurf, not smoothed |
//! |---|---|---|---|---|---|
//! | 0.5 | none | 57,272 | 25 ms | 110 ms | 79 ms |
//! | 0.5 | 25 rounds | 57,272 | 42 ms | 156 ms | 81 ms |
//! | 0.25 | none | 231,858 | 92 ms | 533 ms | 245 ms |
//!
//! These are the times of the passes; `examples/surface_times.rs` also prints the times of
//! [`reconstruct_with`] with sorting and copying. Two thirds of the time are square roots in the field.
//!
//! # Why not the other way
//!
//! The memory of a dense grid is proportional to the volume of the domain instead of that of the
//! fluid. A hash table of edges, the usual way to share vertices, needs atomics and is not
//! reproducible; indices from scans avoid both. Dual contouring places vertices at creases, which
//! water does not have, and can produce edges with four triangles.

mod anisotropy;
mod blocks;
mod buffers;
mod components;
mod droplets;
mod error;
mod field;
mod interpolate;
mod march;
mod mesh;
mod modules;
mod params;
mod parts;
mod reconstruct;
mod smooth;
mod solids;
#[cfg(test)]
mod tests;
mod volume;
mod walls;

#[doc(hidden)]
pub use crate::bodies::Solids;
pub(crate) use buffers::{forecast, largest_per_particle};
pub use components::{remove_small_components, retain_components, take_small_components};
#[doc(hidden)]
pub use droplets::Droplet;
pub use droplets::{MAX_BLOB, droplet_radius, droplets_of, isolated};
pub use error::SurfaceError;
pub use interpolate::interpolate;
#[doc(hidden)]
pub use mesh::SurfaceInput;
pub use mesh::{Surface, SurfaceStats};
#[doc(hidden)]
pub use params::Status;
pub use params::SurfaceParams;
pub use reconstruct::reconstruct_with;
pub use walls::{Walls, remove_caps};

use splashdown_gpu::PassDesc;

/// All passes of surface reconstruction, for the gate and the tests.
#[doc(hidden)]
pub fn passes() -> Vec<&'static PassDesc> {
    vec![
        &droplets::CLASSIFY,
        &droplets::SEPARATE,
        &droplets::KEPT_CELLS,
        &volume::VOLUME,
        &anisotropy::MOMENTS,
        &anisotropy::SHAPES,
        &anisotropy::WEIGHTS,
        &blocks::MARK,
        &blocks::COMPACT,
        &blocks::PLAN,
        &field::FIELD,
        &field::STRETCHED_FIELD,
        &solids::CLIP,
        &solids::PIN,
        &march::COUNT,
        &march::FINISH,
        &march::VERTICES,
        &march::TRIANGLES,
        &smooth::SMOOTHING_WEIGHTS,
        &smooth::VALENCE,
        &smooth::ONE_RING,
        &smooth::ONE_RING_ORDER,
        &smooth::RELAX,
        &smooth::VERTEX_NORMALS,
    ]
}
