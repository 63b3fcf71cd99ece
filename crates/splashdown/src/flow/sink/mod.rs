//! Takes out the particles that are in a sink: they are marked, counted, and behind the living from the next sort on.

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, read, uniform, wgsl, write};

use super::{FLOW, SinkShape};
use crate::cells::{GRID, Grid};
use crate::state::{STATE, STEP_COUNTERS, StepState};

/// See the module.
pub static SINK: PassDesc = PassDesc {
    label: "flow.sink",
    wgsl: include_str!("sink.wgsl"),
    imports: &[wgsl::INDEX, STATE, GRID, STEP_COUNTERS, FLOW],
    entry: "sink",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: &[
        uniform::<Grid>("grid"),
        read::<StepState>("state"),
        read::<u32>("cell_start"),
        read::<SinkShape>("drains"),
        read::<f32>("drain_maps"),
        write::<Vec4>("sorted_positions"),
        write::<u32>("counters"),
    ],
    cpu: cpu::sink,
};
