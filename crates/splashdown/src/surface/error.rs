//! What can go wrong between particles and their surface.

use splashdown_gpu::GpuError;

/// An error of the surface's extraction.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SurfaceError {
    /// The device or its driver.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// A parameter that makes no sense.
    #[error("the surface's {name} is {given}; it must be {allowed}")]
    Parameter {
        /// Its name in [`SurfaceParams`](super::SurfaceParams).
        name: &'static str,
        /// The value given.
        given: f32,
        /// What is allowed.
        allowed: &'static str,
    },
    /// No point of the field is as high as the level of the surface.
    #[error(
        "there is no surface at an iso_level of {given}: the field of these particles goes from 0 outside to {highest:.3} \
         inside; choose one between (0.6 is usual), or smaller cells"
    )]
    NoSurface {
        /// The level given.
        given: f32,
        /// The highest value at any node.
        highest: f32,
    },
    /// The search grid is finer than the kernel.
    #[error(
        "the neighbour grid's cells are {cell_size} m wide, the surface's support_radius is {support_radius} \
         m; cells must be at least as wide as the support: lower surface.support_radius"
    )]
    GridTooFine {
        /// The grid's cell size in m.
        cell_size: f32,
        /// The kernel's support radius in m.
        support_radius: f32,
    },
    /// The region is too large for its resolution.
    #[error(
        "a region of {size:?} m at a surface cell_size of {cell_size} m needs {blocks:.3e} blocks of 8x8x8 nodes, \
         at most {allowed} fit; use a larger cell_size or look for particles far from the others"
    )]
    TooLarge {
        /// Extent in m.
        size: [f32; 3],
        /// The cell size in m.
        cell_size: f32,
        /// Blocks needed.
        blocks: f64,
        /// Blocks that fit.
        allowed: u64,
    },
    /// The region's coordinates are so large that `f32` cannot tell neighbouring nodes apart.
    #[error(
        "coordinates up to {farthest} m cannot be told apart at a surface cell_size of {cell_size} m in 32-bit \
         numbers (at most {allowed} m); use a larger cell_size or move the fluid nearer to the origin"
    )]
    TooFar {
        /// The largest coordinate in m.
        farthest: f32,
        /// The cell size in m.
        cell_size: f32,
        /// The largest coordinate allowed in m.
        allowed: f32,
    },
}
