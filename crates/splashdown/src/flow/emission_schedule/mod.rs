//! Decides which emitters make a layer of particles in this step, and where these go.
//!
//! The fluid in a nozzle travels speed * dt per step; when it has gone a spacing the next layer is due, at the
//! distance that is left over. Layers take the places behind the living, which the sort keeps free; one that
//! finds too few is dropped and counted.

mod cpu;

use splashdown_gpu::{PassDesc, read, uniform, write};

use super::{FLOW, Nozzle};
use crate::cells::{GRID, Grid};
use crate::state::{PARAMS, Params, STATE, StepState};

/// See the module.
pub static EMISSION_SCHEDULE: PassDesc = PassDesc {
    label: "flow.emission_schedule",
    wgsl: include_str!("emission_schedule.wgsl"),
    imports: &[STATE, PARAMS, GRID, FLOW],
    entry: "emission_schedule",
    workgroup_size: [1, 1, 1],
    constants: &[],
    bindings: &[
        uniform::<Params>("params"),
        uniform::<Grid>("grid"),
        read::<StepState>("state"),
        read::<u32>("cell_start"),
        read::<Nozzle>("nozzles"),
        write::<u32>("schedules"),
    ],
    cpu: cpu::emission_schedule,
};
