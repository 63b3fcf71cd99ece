//! Determines whether an update is due, and its time step: the simulated time since the last
//! update.
//!
//! The simulated time is on the device, so that the host does not wait for it. Within a frame an
//! update needs a valid sorted order. A batch of steps that exceeds its frame leaves none; the
//! update is then postponed to the end of the frame, where it is always due.

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
