//! Moves what is in a nozzle as one piston: a = (speed * direction - v) / dt, so that the step ends with that velocity.
//!
//! Particles are born at rest density behind others of the same lattice, a support radius and more before the
//! outlet; until they are there, nothing may push them about, since their lattice still lacks its back half.

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, bindings, wgsl};

use super::{FLOW, Nozzle};
use crate::cells::{GRID, Grid};
use crate::state::{PARAMS, Params, STATE, StepState};

bindings! {
    /// The buffers of `inflow_constraint.wgsl`.
    pub(super) struct InflowConstraintBindings {
        params: uniform Params,
        grid: uniform Grid,
        state: read StepState,
        cell_start: read [u32],
        nozzles: read [Nozzle],
        schedules: read [u32],
        sorted_positions: read [Vec4],
        sorted_velocities: read [Vec4],
        accelerations: write [Vec4],
    }
}

/// See the module.
pub static INFLOW_CONSTRAINT: PassDesc = PassDesc {
    label: "flow.inflow_constraint",
    wgsl: include_str!("inflow_constraint.wgsl"),
    imports: &[wgsl::INDEX, STATE, PARAMS, GRID, FLOW],
    entry: "inflow_constraint",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: InflowConstraintBindings::LIST,
    cpu: |_, slots| cpu::inflow_constraint(slots.into()),
};
