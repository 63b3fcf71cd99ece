//! Moves the fluid in a nozzle like a piston: a = (u - v) / dt, so that the step ends with the velocity u. Before the outlet
//! this is the speed of the emitter along its direction.
//!
//! Particles are created at rest density behind others of the same lattice, more than a support radius before the
//! outlet. Until they reach the outlet no other force acts on them: their kernel support is incomplete at the back face,
//! and pressure forces would scatter them. The fourth component of the acceleration is 1, which exempts them from the
//! shifting.
//!
//! *Contraction.* A jet that falls in air gets faster and therefore thinner. Inside the jet a pressure below that of the
//! air causes this, which pressures that are not negative do not have: the jet kept its width, and its density fell to
//! 560 kg/m^3 where its speed had grown from 1 to 2.4 m/s. In the step in which a particle leaves the nozzle, u therefore
//! contains a velocity towards the axis, with which the divergence of the jet vanishes at the outlet
//! (`shares` in `outlet`). Later the positive pressure of the denser jet limits it. A jet upwards
//! widens in the same way. Fluid around the outlet carries the weight of the jet, which then keeps its width: particles
//! beside the pipe, and in no other, are counted in each step for the next one.

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
        schedules: atomic [u32],
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
