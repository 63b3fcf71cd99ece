//! Adds the hand's acceleration: see [`MouseForce`].

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, read, uniform, wgsl, write};

use super::{MOUSE_FORCE, MouseForce};
use crate::cells::{GRID, Grid};
use crate::state::{STATE, StepState};

/// See the module.
pub static APPLY: PassDesc = PassDesc {
    label: "mouse_force.apply",
    wgsl: include_str!("apply.wgsl"),
    imports: &[wgsl::INDEX, STATE, GRID, MOUSE_FORCE],
    entry: "apply",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: &[
        uniform::<Grid>("grid"),
        read::<StepState>("state"),
        read::<u32>("cell_start"),
        read::<MouseForce>("mouse_force"),
        read::<Vec4>("sorted_positions"),
        read::<Vec4>("sorted_velocities"),
        write::<Vec4>("accelerations"),
    ],
    cpu: cpu::apply,
};
