//! The product of the matrix with the preconditioned residual for the unknowns of bodies, and their contributions to the sums
//! of the iteration (see the [module](super)).

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, bindings};

use super::unknowns;
use crate::bodies::motion;
use crate::bodies::types::{self, Body};
use crate::state::{PARAMS, Params, STATE, StepState, VISCOUS, ViscousState};

bindings! {
    /// The buffers of `viscous_sum.wgsl`.
    pub(super) struct SumBindings {
        params: uniform Params,
        state: uniform StepState,
        viscous: uniform ViscousState,
        bodies: read [Body],
        responses: read [Vec4],
        pressure_sums: write [u32],
        unknowns: write [Vec4],
        residuals: write [Vec4],
    }
}

/// See the module. One invocation, so that the sum has a fixed order.
pub static VISCOUS_SUM: PassDesc = PassDesc {
    label: "bodies.viscous_sum",
    wgsl: include_str!("viscous_sum.wgsl"),
    imports: &[STATE, VISCOUS, PARAMS, types::WGSL, motion::ALGEBRA, unknowns::WGSL, unknowns::SET],
    entry: "viscous_sum",
    workgroup_size: [1, 1, 1],
    constants: &[],
    bindings: SumBindings::LIST,
    cpu: |_, slots| cpu::viscous_sum(slots.into()),
};
