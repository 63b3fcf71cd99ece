//! Writes (cell, number) pairs for the bitonic sort: the thesis's way, kept as a baseline.

mod cpu;

use glam::UVec2;
use splashdown_gpu::{PassDesc, read, uniform, wgsl, write};

use super::{GRID, Grid};
use crate::state::{STATE, StepState};

/// See the module.
pub static KEYS: PassDesc = PassDesc {
    label: "cells.keys",
    wgsl: include_str!("keys.wgsl"),
    imports: &[wgsl::INDEX, STATE, GRID],
    entry: "keys",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: &[
        uniform::<Grid>("grid"),
        read::<StepState>("state"),
        read::<u32>("cell_counts"),
        write::<UVec2>("pairs"),
    ],
    cpu: cpu::keys,
};
