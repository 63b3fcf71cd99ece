//! Which particles are on the surface, and its normal there: n = -H grad c, c = sum_j V W(x_i - x_j), V =
//! particle_spacing^3 (after Mueller, Charypar & Gross 2003).
//!
//! On a plane surface |n| is 1.5, a spacing below it 0.3; half and more is the surface. Fluid at a closed
//! side has none there: what of n points out of the side counts as nothing. The fourth component is 1 on the
//! surface, else all are 0.

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, read, uniform, wgsl, write};

use super::{FOAM, FoamState};
use crate::cells::{GRID, Grid, ROWS};
use crate::kernel;
use crate::state::{PARAMS, Params, STATE};

/// See the module.
pub static NORMALS: PassDesc = PassDesc {
    label: "foam.normals",
    wgsl: include_str!("normals.wgsl"),
    imports: &[wgsl::INDEX, STATE, PARAMS, GRID, ROWS, kernel::WGSL, FOAM],
    entry: "foam_normals",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: &[
        uniform::<Params>("params"),
        uniform::<Grid>("grid"),
        read::<FoamState>("foam_state"),
        read::<u32>("cell_start"),
        read::<Vec4>("sorted_positions"),
        write::<Vec4>("normals"),
    ],
    cpu: cpu::normals,
};
