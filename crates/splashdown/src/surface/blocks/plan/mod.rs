//! Computes the number of workgroups of the passes over blocks, on the device.

mod cpu;

use splashdown_gpu::{PassDesc, read, uniform, wgsl, write};

use crate::surface::modules::{LATTICE, STATUS};
use crate::surface::params::{Lattice, Status};

pub(crate) static PLAN: PassDesc = PassDesc {
    label: "surface.plan",
    wgsl: include_str!("plan.wgsl"),
    imports: &[wgsl::INDEX, STATUS, LATTICE],
    entry: "plan",
    workgroup_size: [1, 1, 1],
    constants: &[],
    bindings: &[
        uniform::<Lattice>("lattice"),
        read::<u32>("mark_starts"),
        write::<Status>("status"),
        write::<u32>("block_groups"),
    ],
    cpu: cpu::plan,
};
