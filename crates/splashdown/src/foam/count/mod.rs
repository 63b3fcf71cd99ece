//! How many diffuse particles each particle of the fluid makes (Ihmsen et al. 2012, equation 8): n = I_k
//! (k_ta I_ta + k_wc I_wc) dt, where each I is a potential's way between its limits, in [0, 1].
//!
//! What is left of n behind the whole number is the probability of one more, by a hash of the particle's id
//! and the update's number: the same on every run, in whatever order the particles lie.

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, read, uniform, wgsl, write};

use super::{FOAM, FoamParams, FoamState};
use crate::cells::{GRID, Grid};

/// See the module.
pub static COUNT: PassDesc = PassDesc {
    label: "foam.count",
    wgsl: include_str!("count.wgsl"),
    imports: &[wgsl::INDEX, GRID, FOAM],
    entry: "count_born",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: &[
        uniform::<Grid>("grid"),
        uniform::<FoamParams>("foam"),
        read::<FoamState>("foam_state"),
        read::<u32>("cell_start"),
        read::<u32>("sorted_ids"),
        read::<Vec4>("potentials"),
        write::<u32>("counts"),
    ],
    cpu: cpu::count,
};
