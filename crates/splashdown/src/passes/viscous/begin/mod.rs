//! Begins the iterations of a step; after the end of a frame there are none.

use splashdown_gpu::{PassDesc, bindings};

use crate::state::{STATE, StepState, VISCOUS, ViscousState};

bindings! {
    /// The buffers of `viscous_begin.wgsl`.
    pub(super) struct BeginBindings {
        state: uniform StepState,
        viscous: write ViscousState,
    }
}

/// See the module.
pub static BEGIN: PassDesc = PassDesc {
    label: "viscous.begin",
    wgsl: include_str!("viscous_begin.wgsl"),
    imports: &[STATE, VISCOUS],
    entry: "viscous_begin",
    workgroup_size: [1, 1, 1],
    constants: &[],
    bindings: BeginBindings::LIST,
    cpu: |_, slots| {
        let BeginBindings { state, viscous } = slots.into();
        *viscous = ViscousState::new(state.run_count == 0);
    },
};
