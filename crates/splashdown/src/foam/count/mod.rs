//! The number of diffuse particles that each particle of the fluid generates (Ihmsen et al. 2012,
//! equation 8): n = I_k (k_ta I_ta + k_wc I_wc) dt, where each I is a potential, mapped linearly
//! from its limits to [0, 1].
//!
//! The fractional part of n is the probability of one more particle, evaluated with a hash of the
//! particle's id and the number of the update: it is reproducible and independent of the order of
//! the particles.

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
