//! Removes the particles inside a sink: they are marked and counted, and the next sort places them behind the active
//! ones.

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, bindings, wgsl};

use super::{FLOW, SinkShape};
use crate::cells::{GRID, Grid};
use crate::state::{STATE, STEP_COUNTERS, StepState};

bindings! {
    /// The buffers of `sink.wgsl`.
    pub(super) struct SinkBindings {
        grid: uniform Grid,
        state: read StepState,
        cell_start: read [u32],
        drains: read [SinkShape],
        drain_maps: read [f32],
        sorted_positions: write [Vec4],
        counters: atomic [u32],
    }
}

/// See the module.
pub static SINK: PassDesc = PassDesc {
    label: "flow.sink",
    wgsl: include_str!("sink.wgsl"),
    imports: &[wgsl::INDEX, STATE, GRID, STEP_COUNTERS, FLOW],
    entry: "sink",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: SinkBindings::LIST,
    cpu: |_, slots| cpu::sink(slots.into()),
};
