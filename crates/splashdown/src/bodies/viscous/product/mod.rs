//! The friction of bodies in the product of the matrix with the preconditioned residual, and its reaction (see the
//! [module](super)).

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, bindings, wgsl};

use super::friction;
use crate::bodies::reaction;
use crate::bodies::types::{self, Body, Contact};
use crate::state::{PARAMS, Params, STATE, StepState, VISCOUS, ViscousState};

bindings! {
    /// The buffers of `viscous_body_product.wgsl`.
    pub(super) struct ProductBindings {
        params: uniform Params,
        state: uniform StepState,
        viscous: uniform ViscousState,
        bodies: read [Body],
        contacts: read [Contact],
        sorted_positions: read [Vec4],
        responses: read [Vec4],
        viscous_residuals: read [Vec4],
        viscous_products: write [Vec4],
        sums: atomic [u32],
    }
}

/// See the module.
pub static VISCOUS_PRODUCT: PassDesc = PassDesc {
    label: "bodies.viscous_product",
    wgsl: include_str!("viscous_body_product.wgsl"),
    imports: &[wgsl::INDEX, STATE, VISCOUS, PARAMS, types::WGSL, friction::WGSL, reaction::WGSL],
    entry: "viscous_body_product",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: ProductBindings::LIST,
    cpu: |_, slots| cpu::viscous_body_product(slots.into()),
};
