//! What bounds the fluid: the box's closed sides.

mod contact;
mod near;
mod walls;

pub(crate) use near::{NearWalls, closed_bounds};
pub use walls::{KernelPair, TABLE_STEPS, WallKernel, WallTerms, Walls, wall_offset, wall_table};

use splashdown_gpu::WgslModule;

/// The integrals of one plane, which [`WGSL`] imports.
pub const PLANES: WgslModule = WgslModule { name: "sph/planes", source: include_str!("planes.wgsl") };
/// The WGSL side of [`Walls`]: `wall_terms`.
pub const WGSL: WgslModule = WgslModule { name: "sph/walls", source: include_str!("walls.wgsl") };
