//! Adds the hand's acceleration: see [`Hand`].

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, read, uniform, wgsl, write};

use super::{HAND, Hand};
use crate::cells::{GRID, Grid};
use crate::passes::{STATE, StepState};

/// See the module.
pub static STIR: PassDesc = PassDesc {
    label: "hand.stir",
    wgsl: include_str!("stir.wgsl"),
    imports: &[wgsl::INDEX, STATE, GRID, HAND],
    entry: "stir",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: &[
        uniform::<Grid>("grid"),
        read::<StepState>("state"),
        read::<u32>("cell_start"),
        read::<Hand>("hand"),
        read::<Vec4>("sorted_positions"),
        read::<Vec4>("sorted_velocities"),
        write::<Vec4>("accelerations"),
    ],
    cpu: cpu::stir,
};
