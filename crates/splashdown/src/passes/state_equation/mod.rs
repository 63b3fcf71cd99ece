//! The pressure before the first step, for the first frame, if the density is integrated instead of summed. The density
//! is the fourth component of the velocities.

mod cpu;

use glam::{Vec2, Vec4};
use splashdown_gpu::{PassDesc, bindings, wgsl};

use crate::state::{PARAMS, Params, STATE, StepState};

bindings! {
    /// The buffers of `state_equation.wgsl`.
    pub(super) struct StateEquationBindings {
        params: uniform Params,
        state: read StepState,
        sorted_velocities: read [Vec4],
        densities: write [Vec2],
    }
}

/// See the module.
pub static STATE_EQUATION: PassDesc = PassDesc {
    label: "state_equation",
    wgsl: include_str!("state_equation.wgsl"),
    imports: &[wgsl::INDEX, STATE, PARAMS],
    entry: "state_equation",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: StateEquationBindings::LIST,
    cpu: |_, slots| cpu::state_equation(slots.into()),
};
