//! The boundary of the fluid: the closed sides of the domain, and the code shared with [`bodies`](crate::bodies).
//!
//! Walls and bodies implement the same three operations, which a scheme calls separately:
//!
//! | operation | walls | bodies |
//! |---|---|---|
//! | density contribution | [`Walls::density_at`], in the density passes | `bodies.boundary_density` |
//! | pressure force, with its reaction | [`WallTerms::acceleration`] with [`part::PRESSURE`] | `bodies.boundary_force.*.pressure` |
//! | all other forces, with theirs | [`WallTerms::acceleration`] with [`part::OTHER`] | `bodies.boundary_force.*.other` |
//!
//! An explicit scheme requests [`Part::All`](part::Part::All), which computes both forces in one pass. A scheme that
//! treats the pressure implicitly requests the other forces and the pressure separately: the operation `acceleration` of
//! its step for fluid and walls, and the stage [`BoundaryForces`](crate::coupling::Stage::BoundaryForces) for bodies.
//! Every request adds its reaction to the sums of the bodies.

mod contact;
pub(crate) mod law;
mod near;
pub mod part;
mod walls;

pub(crate) use near::{NearWalls, closed_bounds};
pub use walls::{KernelPair, TABLE_LEN, TABLE_STEPS, WallKernel, WallTerms, Walls, wall_offset, wall_table};

use splashdown_gpu::WgslModule;

/// The integrals of one plane, which [`WGSL`] imports.
pub const PLANES: WgslModule = WgslModule { name: "sph/planes", source: include_str!("planes.wgsl") };
/// The forces of walls and bodies apart from pressure, and the selection of a [`part`].
pub const LAW: WgslModule = WgslModule { name: "sph/boundary_law", source: include_str!("law.wgsl") };
/// The WGSL side of [`Walls`]: `wall_terms`.
pub const WGSL: WgslModule = WgslModule { name: "sph/walls", source: include_str!("walls.wgsl") };
