//! How many diffuse particles each particle of the fluid makes (Ihmsen et al. 2012, equation 8): n = I_k
//! (k_ta I_ta + k_wc I_wc) dt, where each I is a potential's way between its limits, in [0, 1].
//!
//! What is left of n behind the whole number is the probability of one more, by a hash of the particle's id
//! and the update's number: the same on every run, in whatever order the particles lie.

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, bindings, wgsl};

use super::{FOAM, FoamParams, FoamState};
use crate::cells::{GRID, Grid};

bindings! {
    /// The buffers of `count.wgsl`.
    pub(super) struct CountBindings {
        grid: uniform Grid,
        foam: uniform FoamParams,
        foam_state: read FoamState,
        cell_start: read [u32],
        sorted_ids: read [u32],
        foam_potentials: read [Vec4],
        foam_counts: write [u32],
    }
}

/// See the module.
pub static COUNT: PassDesc = PassDesc {
    label: "foam.count",
    wgsl: include_str!("count.wgsl"),
    imports: &[wgsl::INDEX, GRID, FOAM],
    entry: "count",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: CountBindings::LIST,
    cpu: |_, slots| cpu::count(slots.into()),
};
