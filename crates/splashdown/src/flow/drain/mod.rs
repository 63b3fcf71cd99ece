//! Takes out the particles that are in a sink: they are marked, counted, and behind the living from the next sort on.

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, read, uniform, wgsl, write};

use super::{Drain, FLOW};
use crate::cells::{GRID, Grid};
use crate::passes::{STATE, StepState, TALLY};

/// See the module.
pub static DRAIN: PassDesc = PassDesc {
    label: "flow.drain",
    wgsl: include_str!("drain.wgsl"),
    imports: &[wgsl::INDEX, STATE, GRID, TALLY, FLOW],
    entry: "drain",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: &[
        uniform::<Grid>("grid"),
        read::<StepState>("state"),
        read::<u32>("cell_start"),
        read::<Drain>("drains"),
        read::<f32>("drain_maps"),
        write::<Vec4>("sorted_positions"),
        write::<u32>("tally"),
    ],
    cpu: cpu::drain,
};
