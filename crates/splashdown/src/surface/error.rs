//! Errors of surface reconstruction.

use splashdown_gpu::GpuError;

/// An error of surface reconstruction.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SurfaceError {
    /// An error of the device or its driver.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// A parameter is invalid.
    #[error("the surface's {name} is {given}; it must be {allowed}")]
    Parameter {
        /// Its name in [`SurfaceParams`](super::SurfaceParams).
        name: &'static str,
        /// The given value.
        given: f32,
        /// The allowed values.
        allowed: &'static str,
    },
    /// The field is below the iso level at every node.
    #[error(
        "there is no surface at an iso_level of {given}: the field of these particles goes from 0 outside to {highest:.3} \
         inside; choose one between (0.6 is usual), or smaller cells"
    )]
    NoSurface {
        /// The given iso level.
        given: f32,
        /// The largest value at any node.
        highest: f32,
    },
    /// There are more particles than 32-bit indices.
    #[error("a surface of {given} particles was requested; at most {allowed} particles are supported")]
    TooManyParticles {
        /// Number of particles.
        given: usize,
        /// Largest number of particles.
        allowed: u32,
    },
    /// The cells of the neighbour grid are smaller than the support radius.
    #[error(
        "the neighbour grid's cells are {cell_size} m wide, the surface's support_radius is {support_radius} \
         m; cells must be at least as wide as the support: lower surface.support_ratio"
    )]
    GridTooFine {
        /// The cell size of the grid in m.
        cell_size: f32,
        /// The support radius of the kernel in m.
        support_radius: f32,
    },
    /// The region is too large for the cell size.
    #[error(
        "a region of {size:?} m at a surface cell_size of {cell_size} m needs {blocks:.3e} blocks of 8x8x8 nodes, \
         at most {allowed} fit; use a larger cell_size or look for particles far from the others"
    )]
    TooLarge {
        /// Extent in m.
        size: [f32; 3],
        /// The cell size in m.
        cell_size: f32,
        /// Required number of blocks.
        blocks: f64,
        /// Largest supported number of blocks.
        allowed: u64,
    },
    /// The coordinates are too large for `f32` to distinguish neighbouring nodes.
    #[error(
        "coordinates up to {farthest} m cannot be distinguished at a surface cell_size of {cell_size} m in 32-bit \
         numbers (at most {allowed} m); use a larger cell_size or move the fluid nearer to the origin"
    )]
    TooFar {
        /// The largest coordinate in m.
        farthest: f32,
        /// The cell size in m.
        cell_size: f32,
        /// The largest supported coordinate in m.
        allowed: f32,
    },
}
