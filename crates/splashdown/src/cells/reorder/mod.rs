//! Copies the particles into the order of their cells.

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, read, wgsl, write};

use crate::passes::{STATE, StepState};

/// See the module.
pub static REORDER: PassDesc = PassDesc {
    label: "cells.reorder",
    wgsl: include_str!("reorder.wgsl"),
    imports: &[wgsl::INDEX, STATE],
    entry: "reorder",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: &[
        read::<StepState>("state"),
        read::<u32>("order"),
        read::<Vec4>("positions"),
        read::<Vec4>("velocities"),
        read::<u32>("ids"),
        write::<Vec4>("sorted_positions"),
        write::<Vec4>("sorted_velocities"),
        write::<u32>("sorted_ids"),
    ],
    cpu: cpu::reorder,
};
