//! Generates the new diffuse particles (Ihmsen et al. 2012, section 3.1) in a cylinder around the
//! fluid particle, with a radius of one spacing and a length equal to the displacement in this time
//! step. They have the velocity of the fluid particle plus a small component away from the axis of
//! the cylinder.
//!
//! The cylinder of the paper has half the radius, which causes clusters where a particle generates
//! many, and lies in front of the particle; here it is centred at the particle.

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, bindings};

use super::{AMBIENT_IMPORTS, Diffuse, FoamParams, FoamState};
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
    imports: AMBIENT_IMPORTS,
    entry: "emit",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: EmitBindings::LIST,
    cpu: |_, slots| cpu::emit(slots.into()),
};
