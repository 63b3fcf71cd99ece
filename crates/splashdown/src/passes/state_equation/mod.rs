//! The pressure of a density that is integrated instead of summed, before the first step: what the first frame shows.
//! The density travels in the velocities' fourth component.

mod cpu;

use glam::{Vec2, Vec4};
use splashdown_gpu::{PassDesc, read, uniform, wgsl, write};

use crate::state::{PARAMS, Params, STATE, StepState};

/// See the module.
pub static STATE_EQUATION: PassDesc = PassDesc {
    label: "state_equation",
    wgsl: include_str!("state_equation.wgsl"),
    imports: &[wgsl::INDEX, STATE, PARAMS],
    entry: "state_equation",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: &[
        uniform::<Params>("params"),
        read::<StepState>("state"),
        read::<Vec4>("sorted_velocities"),
        write::<Vec2>("densities"),
    ],
    cpu: cpu::state_equation,
};
