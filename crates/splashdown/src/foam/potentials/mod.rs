//! How willing each particle of the fluid is to make foam (Ihmsen et al. 2012, section 3.1): its three
//! potentials.
//!
//! *Trapped air*, in m/s: sum_j V |v_ij| (1 - v_ij/|v_ij| . x_ij/|x_ij|) W(x_ij), V = particle_spacing^3.
//! Particles that approach each other count twice, those that part not at all.
//!
//! *Wave crest*, without unit: sum_j V (1 - n_i . n_j) W(x_ij) over the surface's particles j behind the
//! surface of i (x_ji . n_i < 0), where it moves along its normal (v . n >= 0.6 |v|).
//!
//! *Energy*, in J/kg: v^2 / 2. The paper has joules; per mass the numbers hold at every resolution.
//!
//! The paper weighs by 1 - r/H without a norm, so that its sums grow with the number of neighbours; a kernel
//! times a volume does not. What is too slow to make foam is passed over: its first two potentials are 0.

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, read, uniform, wgsl, write};

use super::{FOAM, FoamParams, FoamState};
use crate::cells::{GRID, Grid, ROWS};
use crate::kernel;
use crate::state::{PARAMS, Params, STATE};

/// See the module.
pub static POTENTIALS: PassDesc = PassDesc {
    label: "foam.potentials",
    wgsl: include_str!("potentials.wgsl"),
    imports: &[wgsl::INDEX, STATE, PARAMS, GRID, ROWS, kernel::WGSL, FOAM],
    entry: "foam_potentials",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: &[
        uniform::<Params>("params"),
        uniform::<Grid>("grid"),
        uniform::<FoamParams>("foam"),
        read::<FoamState>("foam_state"),
        read::<u32>("cell_start"),
        read::<Vec4>("sorted_positions"),
        read::<Vec4>("sorted_velocities"),
        read::<Vec4>("normals"),
        write::<Vec4>("potentials"),
    ],
    cpu: cpu::potentials,
};
