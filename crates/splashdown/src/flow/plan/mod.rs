//! Decides which emitters make a layer of particles in this step, and where these go.
//!
//! The fluid in a nozzle travels speed * dt per step; when it has gone a spacing the next layer is due, at the
//! distance that is left over. Layers take the places behind the living, which the sort keeps free; one that
//! finds too few is dropped and counted.

mod cpu;

use splashdown_gpu::{PassDesc, read, uniform, write};

use super::{FLOW, Nozzle};
use crate::cells::{GRID, Grid};
use crate::passes::{PARAMS, Params, STATE, StepState};

/// See the module.
pub static PLAN: PassDesc = PassDesc {
    label: "flow.plan",
    wgsl: include_str!("plan.wgsl"),
    imports: &[STATE, PARAMS, GRID, FLOW],
    entry: "plan",
    workgroup_size: [1, 1, 1],
    constants: &[],
    bindings: &[
        uniform::<Params>("params"),
        uniform::<Grid>("grid"),
        read::<StepState>("state"),
        read::<u32>("cell_start"),
        read::<Nozzle>("nozzles"),
        write::<u32>("plans"),
    ],
    cpu: cpu::plan,
};
