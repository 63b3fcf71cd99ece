//! Decides which emitters make a layer of particles in this step, and where these go.
//!
//! The fluid in a nozzle travels speed * dt per step; when it has gone a spacing the next layer is due, at the
//! distance that is left over. Layers take the places behind the living, which the sort keeps free; one that
//! finds too few is dropped and counted.

mod cpu;

use splashdown_gpu::{PassDesc, bindings};

use super::{FLOW, Nozzle};
use crate::cells::{GRID, Grid};
use crate::state::{PARAMS, Params, STATE, StepState};

bindings! {
    /// The buffers of `emission_schedule.wgsl`.
    pub(super) struct EmissionScheduleBindings {
        params: uniform Params,
        grid: uniform Grid,
        state: read StepState,
        cell_start: read [u32],
        nozzles: read [Nozzle],
        schedules: write [u32],
    }
}

/// See the module.
pub static EMISSION_SCHEDULE: PassDesc = PassDesc {
    label: "flow.emission_schedule",
    wgsl: include_str!("emission_schedule.wgsl"),
    imports: &[STATE, PARAMS, GRID, FLOW],
    entry: "emission_schedule",
    workgroup_size: [1, 1, 1],
    constants: &[],
    bindings: EmissionScheduleBindings::LIST,
    cpu: |_, slots| cpu::emission_schedule(slots.into()),
};
