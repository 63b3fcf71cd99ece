//! The data shared by all passes: the constants, the state of a step, its counters, and the buffers.
//!
//! This is the lowest module of the solver and does not depend on cells, walls or schemes. It contains the two passes
//! that only read and write the state: [`begin`] begins a frame, [`end_step`] ends a step.

pub mod begin;
mod carried;
mod counters;
pub mod end_step;
mod fields;
mod list_layers;
mod params;
mod solve;
mod step;
mod suspension;
mod symmetric;
mod viscous;

pub use carried::{
    Array, CARRIED, CARRIED_IMPLICIT, Carried, CarriedArrays, Initial, Kind, Reordered, Update, Values, bits,
    bytes_per_particle,
};
#[cfg(test)]
pub(crate) use carried::{DENSITIES, VELOCITIES};
pub(crate) use carried::{IDS, POSITIONS};
pub use counters::{
    DEAD_DRAINED, DEAD_ESCAPED, DEAD_NON_FINITE, DEAD_UNBORN, StepCounters, WGSL as STEP_COUNTERS,
};
pub(crate) use end_step::finish_step;
pub use fields::{Extras, Fields};
pub(crate) use list_layers::list_layers;
pub use params::{Params, WGSL as PARAMS};
pub use solve::{SolveState, WGSL as SOLVE};
pub use step::{STEPS, StepState, WGSL as STATE};
pub use suspension::{Suspension, WGSL as SUSPENSION};
pub(crate) use symmetric::Symmetric;
pub use symmetric::WGSL as SYMMETRIC;
pub use viscous::{ViscousState, WGSL as VISCOUS};

use splashdown_gpu::PassDesc;

/// The passes of this module.
pub fn passes() -> Vec<&'static PassDesc> {
    vec![&begin::BEGIN, &end_step::END_STEP]
}
