//! Begins the iterations of a step; after the end of a frame there are none.

use splashdown_gpu::{PassDesc, bindings};

use crate::state::{PARAMS, Params, SOLVE, STATE, SolveState, StepState};

bindings! {
    /// The buffers of `implicit_begin.wgsl`.
    pub(super) struct BeginBindings {
        params: uniform Params,
        state: uniform StepState,
        solve: write SolveState,
    }
}

/// See the module.
pub static BEGIN: PassDesc = PassDesc {
    label: "implicit.begin",
    wgsl: include_str!("implicit_begin.wgsl"),
    imports: &[STATE, SOLVE, PARAMS],
    entry: "implicit_begin",
    workgroup_size: [1, 1, 1],
    constants: &[],
    bindings: BeginBindings::LIST,
    cpu: |_, slots| {
        let BeginBindings { params, state, solve } = slots.into();
        *solve = SolveState::new(state.run_count == 0, params.relaxation);
    },
};
