//! After the bitonic sort: takes the particles' numbers out of the pairs, and finds where every cell begins (the
//! thesis's grid indices).

mod cpu;

use glam::UVec2;
use splashdown_gpu::{PassDesc, read, uniform, wgsl, write};

use super::{GRID, Grid};
use crate::state::{STATE, StepState};

/// See the module.
pub static BOUNDS: PassDesc = PassDesc {
    label: "cells.bounds",
    wgsl: include_str!("bounds.wgsl"),
    imports: &[wgsl::INDEX, GRID, STATE],
    entry: "bounds",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: &[
        uniform::<Grid>("grid"),
        read::<StepState>("state"),
        read::<UVec2>("pairs"),
        read::<u32>("ids"),
        write::<u32>("cell_start"),
        write::<UVec2>("entries"),
    ],
    cpu: cpu::bounds,
};
