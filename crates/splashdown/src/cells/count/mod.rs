//! Counts the particles of every cell, and notes each one's cell, where the pass that moves them does not:
//! before the first step of a frame, and after emitters.
//!
//! Dead particles go to one more cell behind the last, so that sorting puts them behind the living. Particles that are
//! outside the domain, or whose position, velocity or density is not finite, are marked dead here, and counted: before
//! their neighbours see them.

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, read, uniform, wgsl, write};

use super::{CELL_COUNTS, GRID, Grid};
use crate::state::{PARAMS, Params, STATE, STEP_COUNTERS, StepState};

/// See the module.
pub static COUNT: PassDesc = PassDesc {
    label: "cells.count",
    wgsl: include_str!("count.wgsl"),
    imports: &[wgsl::INDEX, GRID, STATE, PARAMS, STEP_COUNTERS, CELL_COUNTS],
    entry: "count",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: &[
        uniform::<Params>("params"),
        uniform::<Grid>("grid"),
        read::<StepState>("state"),
        write::<Vec4>("positions"),
        read::<Vec4>("velocities"),
        write::<u32>("cell_counts"),
        write::<u32>("counters"),
    ],
    cpu: cpu::count,
};
