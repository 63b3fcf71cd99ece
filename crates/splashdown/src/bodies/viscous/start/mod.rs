//! The friction of bodies in the first residual and in the diagonal, and its reaction (see the [module](super)).

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, bindings, wgsl};

use super::friction;
use crate::bodies::reaction;
use crate::bodies::types::{self, Body, Contact};
use crate::state::{PARAMS, Params, STATE, StepState, VISCOUS, ViscousState};

bindings! {
    /// The buffers of `viscous_friction.wgsl`.
    pub(super) struct StartBindings {
        params: uniform Params,
        state: uniform StepState,
        viscous: uniform ViscousState,
        bodies: read [Body],
        contacts: read [Contact],
        sorted_positions: read [Vec4],
        sorted_velocities: read [Vec4],
        viscous_residuals: write [Vec4],
        sums: atomic [u32],
    }
}

/// See the module.
pub static VISCOUS_FRICTION: PassDesc = PassDesc {
    label: "bodies.viscous_friction",
    wgsl: include_str!("viscous_friction.wgsl"),
    imports: &[wgsl::INDEX, STATE, VISCOUS, PARAMS, types::WGSL, friction::WGSL, reaction::WGSL],
    entry: "viscous_friction",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: StartBindings::LIST,
    cpu: |_, slots| cpu::viscous_friction(slots.into()),
};
