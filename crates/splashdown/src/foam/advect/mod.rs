//! Moves the diffuse particles there are and says what they are (Ihmsen et al. 2012, section 3.2): by the
//! number of their neighbours in the fluid, spray, foam or bubbles.
//!
//! * Spray flies: x += dt v + dt^2 g / 2, v += dt g.
//! * Foam has the velocity of the fluid round it, sum_j v_j W / sum_j W.
//! * A bubble is drawn to that velocity at the rate `drag` and rises by `buoyancy` times gravity; its v is
//!   exact over the time step.
//!
//! Foam and bubbles move by the mean of their velocities before and after. The fluid is that at the time
//! step's end, and a particle first goes to where its own velocity takes it and then looks round, so that
//! steps of several spacings do no harm. The paper's drag is a part per step; a rate does not depend on the
//! step.
//!
//! Near a closed side the support is cut off: neighbours are divided by the part of its ball that is inside,
//! a product over the sides. What is or was foam, and spray that lies on a side, loses lifetime; closed sides
//! hold particles, open ones let them out.

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, bindings};

use super::{Diffuse, FoamParams, FoamState, LOOK_ROUND};
use crate::cells::Grid;
use crate::state::Params;

bindings! {
    /// The buffers of `advect.wgsl`.
    pub(super) struct AdvectBindings {
        params: uniform Params,
        grid: uniform Grid,
        foam: uniform FoamParams,
        foam_state: read FoamState,
        cell_start: read [u32],
        sorted_positions: read [Vec4],
        sorted_velocities: read [Vec4],
        foam_pool: read [Diffuse],
        foam_moved: write [Diffuse],
        foam_alive: write [u32],
    }
}

/// See the module.
pub static ADVECT: PassDesc = PassDesc {
    label: "foam.advect",
    wgsl: include_str!("advect.wgsl"),
    imports: LOOK_ROUND,
    entry: "advect",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: AdvectBindings::LIST,
    cpu: |_, slots| cpu::advect(slots.into()),
};
