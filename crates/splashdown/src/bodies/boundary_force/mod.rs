//! The forces of bodies on particles, and their reactions: all forces, the pressure part, or the others.
//!
//! A body is an integral of the kernel over its solid:
//!
//! * the pressure of the particle and of its image in the solid acts along the gradient of the kernel fraction;
//! * a positive pressure grows hydrostatically inside the solid;
//! * tangential accelerations are divided by the part of the kernel, 1 - D, that the body leaves open: behind its surface
//!   the fluid would continue. The difference is a force of the body, so that fluid and body conserve momentum;
//! * where the density is integrated, the pressure acts with the factor n.B_i n of the corrected gradients, the adjoint of
//!   the contribution to the density;
//! * where the density is summed, the approach is damped, because the pressure of the image does work that the density
//!   does not account for;
//! * friction is 2 nu A / (H d), where nu is the sum of the material's viscosity and the artificial one
//!   (alpha c0 H / 20, Monaghan 2005), so that no slip drags water at any resolution; where the density is integrated, nu is
//!   at least 0.05 c0 H / 20;
//! * adhesion follows the spline of Akinci et al. (2013);
//! * a limit on the velocity (the contact) stops particles without pressure a quarter of a spacing away.
//!
//! All velocities are relative to the body's. The reaction is summed in 64-bit fixed point by integer atomics, so
//! that the sum does not depend on the order.

mod cpu;

use glam::{Vec2, Vec4};
use splashdown_gpu::{PassDesc, WgslModule, bindings, wgsl};

use super::reaction;
use super::types::{self, Body, Contact};
use crate::boundary::{self, part};
use crate::state::{PARAMS, Params, STATE, SYMMETRIC, StepState};

const IMPORTS: &[WgslModule] =
    &[wgsl::INDEX, STATE, PARAMS, SYMMETRIC, boundary::LAW, types::WGSL, reaction::WGSL];

bindings! {
    /// The buffers of `boundary_force.wgsl`.
    pub(super) struct BoundaryForceBindings {
        params: uniform Params,
        state: uniform StepState,
        bodies: read [Body],
        contacts: read [Contact],
        sorted_positions: read [Vec4],
        sorted_velocities: read [Vec4],
        densities: read [Vec2],
        corrections: read [Vec4],
        accelerations: write [Vec4],
        sums: atomic [u32],
    }
}

/// All forces.
pub static ALL: PassDesc = PassDesc {
    label: "bodies.boundary_force",
    wgsl: include_str!("boundary_force.wgsl"),
    imports: IMPORTS,
    entry: "boundary_force",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: BoundaryForceBindings::LIST,
    cpu: |_, slots| cpu::boundary_force::<{ part::ALL }, false>(slots.into()),
};

/// All forces, with corrected gradients.
pub static CORRECTED: PassDesc = PassDesc {
    label: "bodies.boundary_force.corrected",
    constants: &[("CORRECTED", 1.0)],
    cpu: |_, slots| cpu::boundary_force::<{ part::ALL }, true>(slots.into()),
    ..ALL
};

/// The pressure part, and its reaction.
pub static PRESSURE: PassDesc = PassDesc {
    label: "bodies.boundary_force.pressure",
    constants: &[("FORCES", part::PRESSURE as f64)],
    cpu: |_, slots| cpu::boundary_force::<{ part::PRESSURE }, false>(slots.into()),
    ..ALL
};

/// The other forces, and their reaction.
pub static OTHER: PassDesc = PassDesc {
    label: "bodies.boundary_force.other",
    constants: &[("FORCES", part::OTHER as f64)],
    cpu: |_, slots| cpu::boundary_force::<{ part::OTHER }, false>(slots.into()),
    ..ALL
};
