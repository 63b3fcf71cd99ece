//! The colour field at the nodes of the marked blocks: `phi(x) = sum_j V_j W(x - x_j)`, about 1 in
//! the bulk and 0 outside.
//!
//! # How it works
//!
//! The 512 nodes of a block are 64 rows of eight along x. On the device a workgroup processes a
//! block and an invocation a row: it visits the particles of the cell rows within reach and skips
//! those that are too far in y and z before it evaluates the eight nodes. On the CPU a task
//! processes a block: it packs the particles within reach once ([`pairs`](crate::pairs)) and adds
//! each to the rows within its reach. Both add the particles in a fixed order, so the result does
//! not depend on the number of threads. The signs of each row (inside or outside, eight bits) are
//! stored separately.
//!
//! At closed sides the field is symmetric. A node behind a wall has the value of its mirror image, so
//! that only points in front of the walls are evaluated, with the particles and their images. Its
//! sign is that of a node outside the fluid.
//!
//! # Why not the other way
//!
//! Scattering particles to nodes needs atomic additions of floats, which WebGPU lacks, and is not
//! reproducible. Staging particles in workgroup memory needs a barrier per batch; the 64 rows of a
//! block read the same particles at about the same time, so the cache has the same effect.

mod cpu;
pub(super) mod nodes;
mod stretched;

pub(crate) use stretched::STRETCHED_FIELD;

use glam::Vec4;
use splashdown_gpu::{PassDesc, WgslModule, bindings, wgsl};

use super::modules::{CANDIDATES, GRID, LATTICE, STATUS, WALLS};
use super::params::{Lattice, Status};
use crate::cells::Grid;
use crate::kernel::{self, CubicSpline, Kernel};

/// The nodes, values and signs of a row, which both fields share.
const FIELD_ROW: WgslModule =
    WgslModule { name: "surface/field_row", source: include_str!("field_row.wgsl") };

bindings! {
    /// The buffers of `field.wgsl`.
    pub(super) struct FieldBindings {
        lattice: uniform Lattice,
        grid: uniform Grid,
        status: read Status,
        block_list: read [u32],
        cell_start: read [u32],
        samples: read [Vec4],
        field_values: write [f32],
        signs: write [u32],
    }
}

pub(crate) static FIELD: PassDesc = PassDesc {
    label: "surface.field",
    wgsl: include_str!("field.wgsl"),
    imports: &[wgsl::INDEX, GRID, STATUS, LATTICE, WALLS, kernel::WGSL, CANDIDATES, FIELD_ROW],
    entry: "field",
    workgroup_size: [64, 1, 1],
    constants: &[("KERNEL", CubicSpline::ID as f64)],
    bindings: FieldBindings::LIST,
    cpu: |_, slots| cpu::field(slots.into()),
};
