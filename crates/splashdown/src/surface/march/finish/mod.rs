//! The mesh's size, the arguments of its drawing, and the workgroups of the passes over it; all decided on
//! the device.

mod cpu;

use splashdown_gpu::{PassDesc, read, uniform, write};

use crate::surface::modules::{LATTICE, SPREAD, STATUS};
use crate::surface::params::{Lattice, Status};

pub(crate) static FINISH: PassDesc = PassDesc {
    label: "surface.finish",
    wgsl: include_str!("finish.wgsl"),
    imports: &[STATUS, LATTICE, SPREAD],
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
