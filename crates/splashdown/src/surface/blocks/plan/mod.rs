//! Computes the number of workgroups of the passes over blocks, on the device.

mod cpu;

use splashdown_gpu::{PassDesc, bindings, wgsl};

use crate::surface::modules::{LATTICE, STATUS};
use crate::surface::params::{Lattice, Status};

bindings! {
    /// The buffers of `plan.wgsl`.
    pub(super) struct PlanBindings {
        lattice: uniform Lattice,
        mark_starts: read [u32],
        status: write Status,
        block_groups: write [u32],
    }
}

pub(crate) static PLAN: PassDesc = PassDesc {
    label: "surface.plan",
    wgsl: include_str!("plan.wgsl"),
    imports: &[wgsl::INDEX, STATUS, LATTICE],
    entry: "plan",
    workgroup_size: [1, 1, 1],
    constants: &[],
    bindings: PlanBindings::LIST,
    cpu: |_, slots| cpu::plan(slots.into()),
};
