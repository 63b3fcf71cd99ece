//! Determines which emitters create a layer of particles in this step, and the positions and array indices of these.
//!
//! The fluid in a nozzle advances by speed * dt per step. Once it has advanced by a spacing the next layer is due, at
//! the distance that exceeds the spacing. New particles use the array places behind the active ones, which the sort
//! leaves free. A layer without enough free places is not created, and its particles are counted as refused.
//!
//! The particles beside a pipe that the step has counted (`inflow_constraint`) become those of the step before. Steps
//! without particles to move, such as those after the end of a frame, count nothing and change nothing.

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
