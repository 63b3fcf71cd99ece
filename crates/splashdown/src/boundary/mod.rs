//! The boundary of the fluid: the closed sides of the domain, and the code shared with [`bodies`](crate::bodies).
//!
//! Walls are planes of symmetry: every sum over the neighbours of a particle includes their `Images`. Bodies have any
//! shape and are integrals over their solid. Both implement the same three operations, which a scheme calls separately:
//!
//! | operation | walls | bodies |
//! |---|---|---|
//! | density contribution | images, in the density passes | `bodies.boundary_density` |
//! | pressure force, with its reaction | images, in the passes of [`part::PRESSURE`] | `bodies.boundary_force.pressure` |
//! | all other forces, with theirs | images and friction, in the passes of [`part::OTHER`] | `bodies.boundary_force.other` |
//!
//! An explicit scheme requests [`Part::All`](part::Part::All), which computes both forces in one pass. A scheme that
//! treats the pressure implicitly requests the other forces and the pressure separately: the operation `acceleration` of
//! its step for fluid and walls, and the stage [`BoundaryForces`](crate::coupling::Stage::BoundaryForces) for bodies.
//! Every request adds its reaction to the sums of the bodies.

mod half_space;
mod images;
pub(crate) mod law;
pub mod part;
mod wall_friction;

pub use half_space::{KernelPair, PlaneFraction, SolidDistance, WallKernel};
pub(crate) use images::{Images, Reflection, closed_bounds};
pub(crate) use wall_friction::wall_friction;

use splashdown_gpu::WgslModule;

/// The integrals of a half-space.
pub const PLANES: WgslModule = WgslModule { name: "sph/planes", source: include_str!("planes.wgsl") };
/// The forces of walls and bodies apart from pressure, and the selection of a [`part`].
pub const LAW: WgslModule = WgslModule { name: "sph/boundary_law", source: include_str!("law.wgsl") };
/// The WGSL side of `Images`.
pub const IMAGES: WgslModule = WgslModule { name: "sph/images", source: include_str!("images.wgsl") };
/// The friction of walls, which imports [`PLANES`] and [`LAW`].
pub const WALL_FRICTION: WgslModule =
    WgslModule { name: "sph/wall_friction", source: include_str!("wall_friction.wgsl") };
