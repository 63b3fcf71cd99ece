//! The contribution of bodies to the matrices that correct kernel gradients.
//!
//! The integral of -x (x) grad W over a solid behind a plane at distance d is D along the plane and D + q A across it. The
//! pass writes the part across, (D + q A) n (x) n, with the kernel fraction D as the fourth component of the first vector.

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, bindings, wgsl};

use super::types::{self, Contact};
use crate::state::{PARAMS, Params, STATE};

bindings! {
    /// The buffers of `boundary_matrix.wgsl`.
    pub(super) struct BoundaryMatrixBindings {
        params: uniform Params,
        cell_start: read [u32],
        contacts: read [Contact],
        boundary_matrices: write [Vec4],
    }
}

/// See the module.
pub static BOUNDARY_MATRIX: PassDesc = PassDesc {
    label: "bodies.boundary_matrix",
    wgsl: include_str!("boundary_matrix.wgsl"),
    imports: &[wgsl::INDEX, STATE, PARAMS, types::WGSL],
    entry: "boundary_matrix",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: BoundaryMatrixBindings::LIST,
    cpu: |_, slots| cpu::boundary_matrix(slots.into()),
};
