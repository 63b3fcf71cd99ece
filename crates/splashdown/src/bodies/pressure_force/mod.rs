//! The reaction to the implicit pressure, its continuation along the surface of bodies
//! ([`Contact::continued`](super::types::Contact::continued)), and the contact condition, which stops particles that the
//! pressure has not: see [`boundary_force`](super::boundary_force).

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, bindings, wgsl};

use super::reaction;
use super::types::{self, Body, Contact};
use crate::boundary;
use crate::state::{PARAMS, Params, STATE, StepState};

bindings! {
    /// The buffers of `pressure_force.wgsl`.
    pub(super) struct PressureForceBindings {
        params: uniform Params,
        state: uniform StepState,
        bodies: read [Body],
        contacts: read [Contact],
        sorted_positions: read [Vec4],
        sorted_velocities: read [Vec4],
        predicted: read [Vec4],
        accelerations: write [Vec4],
        sums: atomic [u32],
    }
}

/// See the module.
pub static PRESSURE_FORCE: PassDesc = PassDesc {
    label: "bodies.pressure_force",
    wgsl: include_str!("pressure_force.wgsl"),
    imports: &[wgsl::INDEX, STATE, PARAMS, boundary::LAW, types::WGSL, reaction::WGSL],
    entry: "pressure_force",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: PressureForceBindings::LIST,
    cpu: |_, slots| cpu::pressure_force(slots.into()),
};
