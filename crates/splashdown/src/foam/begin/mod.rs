//! Decides whether an update is due, and its time step: the time that the simulation has passed since the
//! last one.
//!
//! The simulation's clock is on the device, so that nobody has to wait for it. Within a frame an update needs
//! a sorted order that holds: a batch of steps that is longer than its frame leaves none, and then the update
//! waits for the frame's end. There it is always due.

mod cpu;

use splashdown_gpu::{PassDesc, read, uniform, wgsl, write};

use super::{FOAM, FoamParams, FoamState};
use crate::state::{STATE, StepState};

/// See the module.
pub static BEGIN: PassDesc = PassDesc {
    label: "foam.begin",
    wgsl: include_str!("begin.wgsl"),
    imports: &[wgsl::INDEX, STATE, FOAM],
    entry: "begin_foam",
    workgroup_size: [1, 1, 1],
    constants: &[],
    bindings: &[
        uniform::<FoamParams>("foam"),
        read::<StepState>("state"),
        write::<FoamState>("foam_state"),
        write::<u32>("groups"),
    ],
    cpu: cpu::begin,
};
