//! Computes the size of the mesh, the arguments of its indirect draw, and the workgroups of the
//! passes over it, all on the device.

mod cpu;

use splashdown_gpu::{PassDesc, bindings, wgsl};

use crate::surface::modules::{LATTICE, STATUS};
use crate::surface::params::{Lattice, Status};

bindings! {
    /// The buffers of `finish.wgsl`.
    pub(super) struct FinishBindings {
        lattice: uniform Lattice,
        vertex_starts: read [u32],
        triangle_starts: read [u32],
        status: write Status,
        draw_args: write [u32],
        vertex_groups: write [u32],
        triangle_groups: write [u32],
    }
}

pub(crate) static FINISH: PassDesc = PassDesc {
    label: "surface.finish",
    wgsl: include_str!("finish.wgsl"),
    imports: &[wgsl::INDEX, STATUS, LATTICE],
    entry: "finish",
    workgroup_size: [1, 1, 1],
    constants: &[],
    bindings: FinishBindings::LIST,
    cpu: |_, slots| cpu::finish(slots.into()),
};
