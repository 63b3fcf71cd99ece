//! The colour field of ellipsoids: `phi(x) = sum_j w_j P(|G_j (x - c_j)|)` with the matrices `A_j = G_j^T G_j`, centres and
//! weights of [`anisotropy`](crate::surface::anisotropy).
//!
//! As the [field](super) of balls, except that the image of an ellipsoid behind a wall has the reflected matrix. The squared
//! distance `q^2 = d.A d` of the nodes of a row is a polynomial of second order along x, so that an ellipsoid costs one
//! multiplication and one addition per node more than a ball. Four measures save work:
//!
//! * A row is skipped if the least value of this polynomial is not below one.
//! * A block that only particles inside the fluid can reach is inside the fluid: all its values are 1. The weights of these
//!   particles are negative here.
//! * On the device, rows of cells with only such particles are visited within the support radius, because their kernels are
//!   balls.
//! * On the device an invocation evaluates two rows, because reading an ellipsoid costs more than evaluating it.

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, bindings, wgsl};

use crate::cells::Grid;
use crate::kernel::{self, CubicSpline, Kernel};
use crate::surface::field::FIELD_ROW;
use crate::surface::modules::{CANDIDATES, GRID, LATTICE, STATUS, WALLS};
use crate::surface::params::{Lattice, Status};

bindings! {
    /// The buffers of `stretched_field.wgsl`.
    pub(super) struct StretchedFieldBindings {
        lattice: uniform Lattice,
        grid: uniform Grid,
        status: read Status,
        block_list: read [u32],
        cell_start: read [u32],
        samples: read [Vec4],
        kernel_matrices: read [Vec4],
        field_values: write [f32],
        signs: write [u32],
    }
}

pub(crate) static STRETCHED_FIELD: PassDesc = PassDesc {
    label: "surface.stretched_field",
    wgsl: include_str!("stretched_field.wgsl"),
    imports: &[wgsl::INDEX, GRID, STATUS, LATTICE, WALLS, kernel::WGSL, CANDIDATES, FIELD_ROW],
    entry: "stretched_field",
    workgroup_size: [32, 1, 1],
    constants: &[("KERNEL", CubicSpline::ID as f64)],
    bindings: StretchedFieldBindings::LIST,
    cpu: |_, slots| cpu::stretched_field(slots.into()),
};
