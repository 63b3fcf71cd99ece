//! Creates the particles of the layers that are due ([`emission_schedule`](super::emission_schedule)).
//!
//! The search for neighbours uses the sorted order of the step. Particles have moved by at most half a spacing since, or with
//! `dfsph` by the support radius less the distance of the search (`schemes/dfsph.rs`), so that the 27 cubes contain all
//! neighbours. If another particle is too near, as at a submerged outlet, the new particle
//! is not created, and this is counted.

mod cpu;

use glam::{Vec2, Vec4};
use splashdown_gpu::{PassDesc, bindings, wgsl};

use super::{FLOW, Nozzle};
use crate::cells::{GRID, Grid, ROWS};
use crate::state::{PARAMS, Params, STATE};

bindings! {
    /// The buffers of `emit.wgsl`.
    pub(super) struct EmitBindings {
        params: uniform Params,
        grid: uniform Grid,
        cell_start: read [u32],
        nozzles: read [Nozzle],
        points: read [Vec4],
        schedules: atomic [u32],
        positions: write [Vec4],
        velocities: write [Vec4],
        ids: write [u32],
        densities: write [Vec2],
    }
}

/// See the module.
pub static EMIT: PassDesc = PassDesc {
    label: "flow.emit",
    wgsl: include_str!("emit.wgsl"),
    imports: &[wgsl::INDEX, STATE, PARAMS, GRID, ROWS, FLOW],
    entry: "emit",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: EmitBindings::LIST,
    cpu: |_, slots| cpu::emit(slots.into()),
};
