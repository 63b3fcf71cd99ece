//! What bodies add to the density, and the pressure that follows.
//!
//! Summation: rho_i += rho0 (1 - (1 - delta_1)(1 - delta_2)), the shares of the two bodies that matter most,
//! whose overlap counts once. Continuity: d rho_i / dt += -2 rho_i (v_i - v_body).slope, twice for the reason
//! given in [`continuity`](crate::passes::continuity).

mod cpu;

use glam::{Vec2, Vec4};
use splashdown_gpu::{PassDesc, read, uniform, wgsl, write};

use super::types::{self, Body, Contact};
use crate::state::{PARAMS, Params, STATE, StepState};

/// For densities that are summed.
pub static SUMMATION: PassDesc = PassDesc {
    label: "bodies.boundary_density.summation",
    wgsl: include_str!("boundary_density.wgsl"),
    imports: &[wgsl::INDEX, STATE, PARAMS, types::WGSL],
    entry: "boundary_density",
    workgroup_size: [64, 1, 1],
    constants: &[("CONTINUITY", 0.0)],
    bindings: &[
        uniform::<Params>("params"),
        read::<StepState>("state"),
        read::<u32>("living"),
        read::<Body>("bodies"),
        read::<Contact>("contact_list"),
        read::<Vec4>("sorted_positions"),
        read::<Vec4>("sorted_velocities"),
        write::<Vec2>("densities"),
    ],
    cpu: cpu::boundary_density::<false>,
};

/// For densities that are integrated.
pub static CONTINUITY: PassDesc = PassDesc {
    label: "bodies.boundary_density.continuity",
    constants: &[("CONTINUITY", 1.0)],
    cpu: cpu::boundary_density::<true>,
    ..SUMMATION
};
