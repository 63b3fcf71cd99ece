//! One iteration of smoothing: every vertex moves towards the mean of its neighbours by its weight.
//!
//! Walls are planes of symmetry. A vertex beside a wall moves along it, the others do not reach it, and
//! neighbours on walls do not count: the free surface is smoothed as if it continued in its mirror
//! image, and the vertices on a wall follow it. Vertices of weight zero, which are those on bodies and those far from all
//! particles, do not count either; they hold their neighbours in place.

mod cpu;

use glam::{UVec2, Vec4};
use splashdown_gpu::{PassDesc, bindings, wgsl};

use crate::surface::modules::{LATTICE, STATUS, WALLS};
use crate::surface::params::{Lattice, Status};

bindings! {
    /// The buffers of `relax.wgsl`.
    pub(super) struct RelaxBindings {
        lattice: uniform Lattice,
        status: read Status,
        one_ring_starts: read [u32],
        one_rings: read [UVec2],
        before: read [Vec4],
        after: write [Vec4],
    }
}

pub(crate) static RELAX: PassDesc = PassDesc {
    label: "surface.relax",
    wgsl: include_str!("relax.wgsl"),
    imports: &[wgsl::INDEX, STATUS, LATTICE, WALLS],
    entry: "relax",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: RelaxBindings::LIST,
    cpu: |_, slots| cpu::relax(slots.into()),
};
