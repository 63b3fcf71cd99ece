//! Begins a frame: sets its length and wakes the particles.
//!
//! A frame of length zero only wakes them, for a sort without a step.

mod cpu;

use splashdown_gpu::{PassDesc, read, uniform, write};

use super::{PARAMS, Params, STATE, StepState};

/// See the module.
pub static BEGIN: PassDesc = PassDesc {
    label: "begin",
    wgsl: include_str!("begin.wgsl"),
    imports: &[STATE, PARAMS],
    entry: "begin",
    workgroup_size: [1, 1, 1],
    constants: &[],
    bindings: &[uniform::<Params>("params"), read::<f32>("duration"), write::<StepState>("state")],
    cpu: cpu::begin,
};
