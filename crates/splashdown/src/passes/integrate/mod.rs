//! Symplectic Euler: v += dt a, x += dt v, from the sorted arrays back into the persistent ones.
//!
//! [`shifted_integrate`](super::shifted_integrate) adds a shifting velocity: x += dt (v + s).
//!
//! It is equivalent to the leap-frog of the thesis: v here is the velocity at t + dt/2 there.
//!
//! Closed walls limit the velocity. A particle that would come nearer than a quarter of a spacing within this step loses
//! the part of its speed that would take it there. Pressure keeps contiguous fluid off the wall; the limit acts on
//! isolated particles, which have no pressure. A particle that is outside nevertheless is moved back and counted; the
//! count is zero in a sound run. A particle whose new state is not finite remains where it was, and is removed and
//! counted, as is one that leaves through an open side.
//!
//! The particles are counted by cell for the sort of the next step, unless emission precedes that sort, or no step
//! follows in this frame.

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

/// Without the count for the next step, which a pass of [`cells`](crate::cells) computes.
pub static UNCOUNTED: PassDesc = PassDesc {
    label: "integrate.uncounted",
    constants: &[("COUNTS", 0.0)],
    cpu: |_, slots| cpu::integrate::<false>(slots.into()),
    ..INTEGRATE
};
