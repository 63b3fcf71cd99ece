//! How many workgroups the passes over blocks get, decided on the device.

mod cpu;

use splashdown_gpu::{PassDesc, read, uniform, write};

use crate::surface::modules::{LATTICE, SPREAD, STATUS};
use crate::surface::params::{Lattice, Status};

pub(crate) static PLAN: PassDesc = PassDesc {
    label: "surface.plan",
    wgsl: include_str!("plan.wgsl"),
    imports: &[STATUS, LATTICE, SPREAD],
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
