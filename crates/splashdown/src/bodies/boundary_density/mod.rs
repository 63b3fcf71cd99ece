//! The contribution of bodies to the density, and the resulting pressure.
//!
//! Summation: rho_i += rho0 (delta_1 + delta_2), with the contributions delta of the two nearest bodies, which the lookup
//! has limited to their union. Continuity: d rho_i / dt += -2 rho_i (n.B_i n) (v_i - v_body).slope, with the
//! factor 2 because the image of the fluid in the body mirrors its motion, the direction n of the slope, and the matrix
//! B_i that corrects the gradients.

mod cpu;

use glam::{Vec2, Vec4};
use splashdown_gpu::{PassDesc, bindings, wgsl};

use super::types::{self, Body, Contact};
use crate::state::{PARAMS, Params, STATE, SYMMETRIC, StepState};

bindings! {
    /// The buffers of `boundary_density.wgsl`.
    pub(super) struct BoundaryDensityBindings {
        params: uniform Params,
        state: uniform StepState,
        cell_start: read [u32],
        bodies: read [Body],
        contacts: read [Contact],
        sorted_positions: read [Vec4],
        sorted_velocities: read [Vec4],
        corrections: read [Vec4],
        densities: write [Vec2],
    }
}

/// For density summation.
pub static SUMMATION: PassDesc = PassDesc {
    label: "bodies.boundary_density.summation",
    wgsl: include_str!("boundary_density.wgsl"),
    imports: &[wgsl::INDEX, STATE, PARAMS, SYMMETRIC, types::WGSL],
    entry: "boundary_density",
    workgroup_size: [64, 1, 1],
    constants: &[("CONTINUITY", 0.0)],
    bindings: BoundaryDensityBindings::LIST,
    cpu: |_, slots| cpu::boundary_density::<false>(slots.into()),
};

/// For the continuity equation.
pub static CONTINUITY: PassDesc = PassDesc {
    label: "bodies.boundary_density.continuity",
    constants: &[("CONTINUITY", 1.0)],
    cpu: |_, slots| cpu::boundary_density::<true>(slots.into()),
    ..SUMMATION
};
