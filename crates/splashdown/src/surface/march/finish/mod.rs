//! Computes the size of the mesh, the arguments of its indirect draw, and the workgroups of the
//! passes over it, all on the device.

mod cpu;

use splashdown_gpu::{PassDesc, read, uniform, wgsl, write};

use crate::surface::modules::{LATTICE, STATUS};
use crate::surface::params::{Lattice, Status};

pub(crate) static FINISH: PassDesc = PassDesc {
    label: "surface.finish",
    wgsl: include_str!("finish.wgsl"),
    imports: &[wgsl::INDEX, STATUS, LATTICE],
    entry: "finish",
    workgroup_size: [1, 1, 1],
    constants: &[],
    bindings: &[
        uniform::<Lattice>("lattice"),
        read::<u32>("vertex_starts"),
        read::<u32>("triangle_starts"),
        write::<Status>("status"),
        write::<u32>("draw_args"),
        write::<u32>("vertex_groups"),
        write::<u32>("triangle_groups"),
    ],
    cpu: cpu::finish,
};
