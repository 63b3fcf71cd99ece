//! Makes the diffuse particles that are born (Ihmsen et al. 2012, section 3.1): in the cylinder round the
//! fluid's particle with a radius of one spacing and as long as its way in this time step, with its velocity
//! and a little more away from the cylinder's axis.
//!
//! The paper's cylinder is half as wide, which leaves clumps where a particle makes many, and lies before the
//! particle; here its middle is the particle's place.

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, bindings};

use super::{Diffuse, FoamParams, FoamState, LOOK_ROUND};
use crate::cells::Grid;
use crate::state::Params;

bindings! {
    /// The buffers of `emit.wgsl`.
    pub(super) struct EmitBindings {
        params: uniform Params,
        grid: uniform Grid,
        foam: uniform FoamParams,
        foam_state: read FoamState,
        cell_start: read [u32],
        foam_starts: read [u32],
        sorted_positions: read [Vec4],
        sorted_velocities: read [Vec4],
        sorted_ids: read [u32],
        foam_pool: write [Diffuse],
    }
}

/// See the module.
pub static EMIT: PassDesc = PassDesc {
    label: "foam.emit",
    wgsl: include_str!("emit.wgsl"),
    imports: LOOK_ROUND,
    entry: "emit",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: EmitBindings::LIST,
    cpu: |_, slots| cpu::emit(slots.into()),
};
