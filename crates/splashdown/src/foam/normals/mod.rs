//! Surface particles and their normals: n = -H grad c, c = sum_j V W(x_i - x_j), V =
//! particle_spacing^3 (after Mueller, Charypar & Gross 2003).
//!
//! On a plane surface |n| is 1.5, one spacing below it 0.3; particles with at least 0.5 are on the
//! surface. Fluid at a closed side has no surface there: components of n that point out of the side
//! are set to zero. The w component is 1 on the surface; otherwise all components are 0.

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, bindings, wgsl};

use super::{FOAM, FoamState};
use crate::cells::{GRID, Grid, ROWS};
use crate::kernel;
use crate::state::{PARAMS, Params, STATE};

bindings! {
    /// The buffers of `normals.wgsl`.
    pub(super) struct NormalsBindings {
        params: uniform Params,
        grid: uniform Grid,
        foam_state: read FoamState,
        cell_start: read [u32],
        sorted_positions: read [Vec4],
        foam_normals: write [Vec4],
    }
}

/// See the module.
pub static NORMALS: PassDesc = PassDesc {
    label: "foam.normals",
    wgsl: include_str!("normals.wgsl"),
    imports: &[wgsl::INDEX, STATE, PARAMS, GRID, ROWS, kernel::WGSL, FOAM],
    entry: "normals",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: NormalsBindings::LIST,
    cpu: |_, slots| cpu::normals(slots.into()),
};
