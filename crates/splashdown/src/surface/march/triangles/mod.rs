//! The triangles of every cell, as vertex indices.
//!
//! A triangle with a vertex beyond the capacity gets three equal indices: it is not drawn, and no
//! access is out of range.

mod cpu;

use glam::UVec2;
use splashdown_gpu::{PassDesc, read, uniform, wgsl, write};

use crate::surface::modules::{LATTICE, SIGNS, SLOTS, STATUS};
use crate::surface::params::{Lattice, Status};

pub(crate) static TRIANGLES: PassDesc = PassDesc {
    label: "surface.triangles",
    wgsl: include_str!("triangles.wgsl"),
    imports: &[wgsl::INDEX, STATUS, LATTICE, SLOTS, SIGNS],
    entry: "triangles",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: &[
        uniform::<Lattice>("lattice"),
        read::<Status>("status"),
        read::<u32>("block_list"),
        read::<u32>("block_slot"),
        read::<UVec2>("rows"),
        read::<UVec2>("cases"),
        read::<u32>("vertex_starts"),
        read::<u32>("triangle_starts"),
        write::<u32>("indices"),
    ],
    cpu: cpu::triangles,
};
