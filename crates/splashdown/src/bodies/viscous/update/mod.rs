//! Changes the velocities of bodies along the next direction, and their residual (see the [module](super)).

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, bindings};

use super::unknowns;
use crate::bodies::motion;
use crate::bodies::types::{self, Body};
use crate::state::{STATE, StepState, VISCOUS, ViscousState};

bindings! {
    /// The buffers of `viscous_body_update.wgsl`.
    pub(super) struct UpdateBindings {
        state: uniform StepState,
        viscous: uniform ViscousState,
        bodies: read [Body],
        responses: write [Vec4],
        unknowns: write [Vec4],
    }
}

/// See the module.
pub static VISCOUS_BODY_UPDATE: PassDesc = PassDesc {
    label: "bodies.viscous_update",
    wgsl: include_str!("viscous_body_update.wgsl"),
    imports: &[STATE, VISCOUS, types::WGSL, motion::ALGEBRA, unknowns::WGSL, unknowns::SET],
    entry: "viscous_body_update",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: UpdateBindings::LIST,
    cpu: |_, slots| cpu::viscous_body_update(slots.into()),
};
