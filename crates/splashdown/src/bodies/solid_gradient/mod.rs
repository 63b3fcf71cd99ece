//! What bodies contribute to the system of the implicit pressure: the gradient b of the density with respect to the
//! particle, and its product with the velocity of the bodies. A dynamic body enlarges the diagonal, by a bound of what
//! the pressures on it do to one another, so that the iterations of a light body converge.

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, bindings, wgsl};

use super::types::{self, Body, Contact};
use crate::state::{PARAMS, Params, STATE, StepState};

bindings! {
    /// The buffers of `solid_gradient.wgsl`.
    pub(super) struct SolidGradientBindings {
        params: uniform Params,
        state: uniform StepState,
        bodies: read [Body],
        contacts: read [Contact],
        sorted_positions: read [Vec4],
        stiffness: write [Vec4],
        solid_gradients: write [Vec4],
    }
}

/// See the module.
pub static SOLID_GRADIENT: PassDesc = PassDesc {
    label: "bodies.solid_gradient",
    wgsl: include_str!("solid_gradient.wgsl"),
    imports: &[wgsl::INDEX, STATE, PARAMS, types::WGSL],
    entry: "solid_gradient",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: SolidGradientBindings::LIST,
    cpu: |_, slots| cpu::solid_gradient(slots.into()),
};
