//! Moves what is in a nozzle as one piston: a = (speed * direction - v) / dt, so that the step ends with that velocity.
//!
//! Particles are born at rest density behind others of the same lattice, a support radius and more before the
//! outlet; until they are there, nothing may push them about, since their lattice still lacks its back half.

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, read, uniform, wgsl, write};

use super::{FLOW, Nozzle};
use crate::cells::{GRID, Grid};
use crate::passes::{PARAMS, Params, STATE, StepState};

/// See the module.
pub static DRIVE: PassDesc = PassDesc {
    label: "flow.drive",
    wgsl: include_str!("drive.wgsl"),
    imports: &[wgsl::INDEX, STATE, PARAMS, GRID, FLOW],
    entry: "drive",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: &[
        uniform::<Params>("params"),
        uniform::<Grid>("grid"),
        read::<StepState>("state"),
        read::<u32>("cell_start"),
        read::<Nozzle>("nozzles"),
        read::<u32>("plans"),
        read::<Vec4>("sorted_positions"),
        read::<Vec4>("sorted_velocities"),
        write::<Vec4>("accelerations"),
    ],
    cpu: cpu::drive,
};
