//! Makes the diffuse particles that are born (Ihmsen et al. 2012, section 3.1): in the cylinder round the
//! fluid's particle with a radius of one spacing and as long as its way in this time step, with its velocity
//! and a little more away from the cylinder's axis.
//!
//! The paper's cylinder is half as wide, which leaves clumps where a particle makes many, and lies before the
//! particle; here its middle is the particle's place.

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, read, uniform, write};

use super::{Diffuse, FoamParams, FoamState, LOOK_ROUND};
use crate::cells::Grid;
use crate::state::Params;

/// See the module.
pub static EMIT: PassDesc = PassDesc {
    label: "foam.emit",
    wgsl: include_str!("emit.wgsl"),
    imports: LOOK_ROUND,
    entry: "emit_foam",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: &[
        uniform::<Params>("params"),
        uniform::<Grid>("grid"),
        uniform::<FoamParams>("foam"),
        read::<FoamState>("foam_state"),
        read::<u32>("cell_start"),
        read::<u32>("starts"),
        read::<Vec4>("sorted_positions"),
        read::<Vec4>("sorted_velocities"),
        read::<u32>("sorted_ids"),
        write::<Diffuse>("pool"),
    ],
    cpu: cpu::emit,
};
