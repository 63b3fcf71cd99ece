//! The product of the matrix with the preconditioned residual (see the [module](super)).
//!
//! Also sums, over each 64 particles, r.z, z.A z, r.r and z.z.

mod cpu;

use glam::{UVec4, Vec4};
use splashdown_gpu::{PassDesc, bindings, wgsl};

use super::pair;
use crate::boundary;
use crate::cells::{CANDIDATES, GRID, Grid, ROWS};
use crate::passes::group_sum;
use crate::passes::neighbours::{NEIGHBOUR_ENTRIES, NEIGHBOURS};
use crate::state::{PARAMS, Params, STATE, StepState, VISCOUS, ViscousState};

bindings! {
    /// The buffers of `viscous_product.wgsl`.
    pub(super) struct ProductBindings {
        params: uniform Params,
        grid: uniform Grid,
        state: uniform StepState,
        viscous: uniform ViscousState,
        cell_start: read [u32],
        sorted_positions: read [Vec4],
        neighbours: read [UVec4],
        viscous_residuals: read [Vec4],
        viscous_products: write [Vec4],
        residuals: write [Vec4],
    }
}

/// See the module.
pub static PRODUCT: PassDesc = PassDesc {
    label: "viscous.product",
    wgsl: include_str!("viscous_product.wgsl"),
    imports: &[
        wgsl::INDEX,
        STATE,
        VISCOUS,
        PARAMS,
        GRID,
        ROWS,
        boundary::IMAGES,
        CANDIDATES,
        NEIGHBOURS,
        NEIGHBOUR_ENTRIES,
        pair::WGSL,
        group_sum::WGSL,
    ],
    entry: "viscous_product",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: ProductBindings::LIST,
    cpu: |work, slots| cpu::product::<false>(work.scratch, slots.into()),
};

/// With bodies, whose friction the products contain before.
pub static BODIES: PassDesc = PassDesc {
    label: "viscous.product.bodies",
    constants: &[("BODIES", 1.0)],
    cpu: |work, slots| cpu::product::<true>(work.scratch, slots.into()),
    ..PRODUCT
};
