//! Puts the number of every particle into its cell's part of `slots`, in the order of arrival.

mod cpu;

use glam::UVec2;
use splashdown_gpu::{PassDesc, read, wgsl, write};

use crate::passes::{STATE, StepState};

/// See the module.
pub static SCATTER: PassDesc = PassDesc {
    label: "cells.scatter",
    wgsl: include_str!("scatter.wgsl"),
    imports: &[wgsl::INDEX, STATE],
    entry: "scatter",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: &[
        read::<StepState>("state"),
        read::<UVec2>("cell_rank"),
        read::<u32>("cell_start"),
        write::<u32>("slots"),
    ],
    cpu: cpu::scatter,
};
