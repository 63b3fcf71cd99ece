//! The reaction of bodies to the friction at the accepted velocities (see the [module](super)).

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, bindings, wgsl};

use super::{friction, unknowns};
use crate::bodies::types::{self, Body, Contact};
use crate::bodies::{motion, reaction};
use crate::state::{PARAMS, Params, STATE, StepState, VISCOUS, ViscousState};

bindings! {
    /// The buffers of `viscous_force.wgsl`.
    pub(super) struct ForceBindings {
        params: uniform Params,
        state: uniform StepState,
        viscous: uniform ViscousState,
        bodies: read [Body],
        contacts: read [Contact],
        unknowns: read [Vec4],
        sorted_positions: read [Vec4],
        sorted_velocities: read [Vec4],
        viscous_residuals: read [Vec4],
        predicted: read [Vec4],
        sums: atomic [u32],
    }
}

/// See the module.
pub static VISCOUS_FORCE: PassDesc = PassDesc {
    label: "bodies.viscous_force",
    wgsl: include_str!("viscous_force.wgsl"),
    imports: &[
        wgsl::INDEX,
        STATE,
        VISCOUS,
        PARAMS,
        types::WGSL,
        friction::WGSL,
        motion::ALGEBRA,
        unknowns::WGSL,
        reaction::WGSL,
    ],
    entry: "viscous_force",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: ForceBindings::LIST,
    cpu: |_, slots| cpu::viscous_force(slots.into()),
};
