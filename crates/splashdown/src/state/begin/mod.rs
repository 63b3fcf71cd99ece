//! Begins a frame: sets its start, its duration and the number of particles to process.
//!
//! Also limits the first step to what the parameters allow, which may have changed since the last one. A frame of zero
//! seconds serves a sort without a step.

mod cpu;

use splashdown_gpu::{PassDesc, bindings};

use super::{PARAMS, Params, STATE, StepState};

bindings! {
    /// The buffers of `begin.wgsl`.
    pub(super) struct BeginBindings {
        params: uniform Params,
        frame_input: read [f32],
        state: write StepState,
    }
}

/// See the module.
pub static BEGIN: PassDesc = PassDesc {
    label: "begin",
    wgsl: include_str!("begin.wgsl"),
    imports: &[STATE, PARAMS],
    entry: "begin",
    workgroup_size: [1, 1, 1],
    constants: &[],
    bindings: BeginBindings::LIST,
    cpu: |_, slots| cpu::begin(slots.into()),
};
