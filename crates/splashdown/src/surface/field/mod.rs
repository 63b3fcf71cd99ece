//! The colour field at the nodes of the marked blocks: `phi(x) = sum_j V_j W(x - x_j)`, about 1 in the bulk
//! and 0 outside.
//!
//! # How it works
//!
//! A block's 512 nodes are 64 rows of eight along x, the width of a vector register and of two `vec4`. On the
//! device a workgroup takes a block and an invocation a row: it walks the particles of the cell rows in reach
//! and leaves those out that are too far in y and z before it looks at the eight nodes. On the CPU a task
//! takes a block: it gathers the particles in reach once and adds each to the rows it touches. Both add in
//! the order of the particles, so the result does not depend on threads. Each row's signs (inside or not,
//! eight bits) are stored beside.
//!
//! # Why not the other way
//!
//! Scattering particles to nodes needs atomic additions of floats, which WebGPU lacks, and gives other bits
//! every time. Staging particles in workgroup memory needs a barrier per batch; the 64 rows of a block read
//! the same particles at about the same time, so the cache does it.

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, read, uniform, wgsl, write};

use super::modules::{CANDIDATES, GRID, LATTICE, SPLINE, STATUS};
use super::params::{Lattice, Status};
use crate::cells::Grid;

pub(crate) static FIELD: PassDesc = PassDesc {
    label: "surface.field",
    wgsl: include_str!("field.wgsl"),
    imports: &[wgsl::INDEX, GRID, STATUS, LATTICE, SPLINE, CANDIDATES],
    entry: "field",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: &[
        uniform::<Lattice>("lattice"),
        uniform::<Grid>("grid"),
        read::<Status>("status"),
        read::<u32>("block_list"),
        read::<u32>("cell_start"),
        read::<Vec4>("samples"),
        write::<f32>("values"),
        write::<u32>("signs"),
    ],
    cpu: cpu::field,
};
