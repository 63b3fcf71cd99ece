//! Decides whether an update is due, and its time step: the time that the simulation has passed since the
//! last one.
//!
//! The simulation's clock is on the device, so that nobody has to wait for it. Within a frame an update needs
//! a sorted order that holds: a batch of steps that is longer than its frame leaves none, and then the update
//! waits for the frame's end. There it is always due.

mod cpu;

use splashdown_gpu::{PassDesc, bindings, wgsl};

use super::{FOAM, FoamParams, FoamState};
use crate::state::{STATE, StepState};

bindings! {
    /// The buffers of `begin.wgsl`.
    pub(super) struct BeginBindings {
        foam: uniform FoamParams,
        state: read StepState,
        foam_state: write FoamState,
        foam_groups: write [u32],
    }
}

/// See the module.
pub static BEGIN: PassDesc = PassDesc {
    label: "foam.begin",
    wgsl: include_str!("begin.wgsl"),
    imports: &[wgsl::INDEX, STATE, FOAM],
    entry: "begin",
    workgroup_size: [1, 1, 1],
    constants: &[],
    bindings: BeginBindings::LIST,
    cpu: |_, slots| cpu::begin(slots.into()),
};
