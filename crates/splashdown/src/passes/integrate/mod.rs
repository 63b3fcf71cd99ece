//! Symplectic Euler: v += dt a, x += dt v, from the sorted arrays back into the persistent ones.
//!
//! It is the leap-frog of the thesis read at half steps: v here is v at t + dt/2 there. Closed walls are a
//! contact in the velocities: a particle nearer than a quarter of a spacing, or on its way there within this
//! step, loses just the speed that would take it past. Pressure keeps a body of fluid off the wall; this holds
//! the lone drops that have none. A particle that is outside all the same is put back and counted: the count is
//! zero in a sound run. A result that is not finite leaves the particle where it was, dead, and is counted; so
//! is one that leaves through an open side.
//!
//! The particles are counted by cell for the next step's sort, unless emitters are to make more before it, or
//! there is no next step in this frame.

mod cpu;

use glam::{Vec2, Vec4};
use splashdown_gpu::{PassDesc, bindings, wgsl};

use super::ADVANCE;
use crate::boundary;
use crate::cells::{CELL_COUNTS, GRID, Grid};
use crate::state::{PARAMS, Params, STATE, STEP_COUNTERS, StepState};

bindings! {
    /// The buffers of `integrate.wgsl`.
    pub(super) struct IntegrateBindings {
        params: uniform Params,
        grid: uniform Grid,
        state: uniform StepState,
        sorted_positions: read [Vec4],
        sorted_velocities: read [Vec4],
        densities: read [Vec2],
        accelerations: read [Vec4],
        positions: write [Vec4],
        velocities: write [Vec4],
        counters: atomic [u32],
        cell_counts: atomic [u32],
    }
}

/// See the module.
pub static INTEGRATE: PassDesc = PassDesc {
    label: "integrate",
    wgsl: include_str!("integrate.wgsl"),
    imports: &[wgsl::INDEX, STATE, PARAMS, STEP_COUNTERS, GRID, CELL_COUNTS, boundary::LAW, ADVANCE],
    entry: "integrate",
    workgroup_size: [256, 1, 1],
    constants: &[],
    bindings: IntegrateBindings::LIST,
    cpu: |_, slots| cpu::integrate::<true>(slots.into()),
};

/// Leaves the count for the next step to [`cells`](crate::cells).
pub static UNCOUNTED: PassDesc = PassDesc {
    label: "integrate.uncounted",
    constants: &[("COUNTS", 0.0)],
    cpu: |_, slots| cpu::integrate::<false>(slots.into()),
    ..INTEGRATE
};
