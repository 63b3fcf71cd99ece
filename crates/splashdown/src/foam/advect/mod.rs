//! Moves and classifies the diffuse particles (Ihmsen et al. 2012, section 3.2): the number of
//! neighbours in the fluid determines whether a particle is spray, foam or a bubble.
//!
//! * Spray is ballistic: x += dt v + dt^2 g / 2, v += dt g.
//! * Foam has the velocity of the surrounding fluid, sum_j v_j W / sum_j W.
//! * The velocity of a bubble relaxes to that velocity at the rate `drag`, with an additional
//!   acceleration of `buoyancy` times gravity upwards; it is integrated exactly over the time step.
//!
//! Foam and bubbles move with the mean of their velocities before and after. The fluid is that at
//! the end of the time step, and its velocity is evaluated at the position predicted with the
//! particle's own velocity, so that displacements of several spacings are possible. In the paper
//! the drag is a fraction per step; a rate does not depend on the time step.
//!
//! Near a closed side the support is truncated: the number of neighbours is divided by the fraction
//! of the support that is inside, a product over the sides. The lifetime of foam, of former foam,
//! and of spray on a side decreases. Closed sides confine particles; particles leave through open
//! sides.

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, bindings};

use super::{AMBIENT_IMPORTS, Diffuse, FoamParams, FoamState};
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
    imports: AMBIENT_IMPORTS,
    entry: "advect",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: AdvectBindings::LIST,
    cpu: |_, slots| cpu::advect(slots.into()),
};
