//! The unknowns of the bodies at the beginning of a step (see the [module](super)). Bodies that forces do not move have their
//! velocity as the solution and no residual.

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, bindings};

use super::unknowns;
use crate::bodies::motion;
use crate::bodies::types::{self, Body};
use crate::state::{PARAMS, Params, STATE, StepState, VISCOUS, ViscousState};

bindings! {
    /// The buffers of `viscous_bodies.wgsl`.
    pub(super) struct BeginBindings {
        params: uniform Params,
        state: uniform StepState,
        viscous: uniform ViscousState,
        bodies: read [Body],
        sums: read [u32],
        pressure_sums: write [u32],
        responses: write [Vec4],
        unknowns: write [Vec4],
    }
}

/// See the module.
pub static VISCOUS_BODIES: PassDesc = PassDesc {
    label: "bodies.viscous_bodies",
    wgsl: include_str!("viscous_bodies.wgsl"),
    imports: &[
        STATE,
        VISCOUS,
        PARAMS,
        types::WGSL,
        motion::ALGEBRA,
        motion::VELOCITIES,
        unknowns::WGSL,
        unknowns::SET,
    ],
    entry: "viscous_bodies",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: BeginBindings::LIST,
    cpu: |_, slots| cpu::viscous_bodies(slots.into()),
};
