//! Writes the particles of the layers that are due ([`emission_schedule`](super::plan)).
//!
//! The sorted order of the step still holds: particles have moved by half a spacing at most since, so that the
//! 27 cells show everything within reach. Where another particle is in the way, as in an outlet under water,
//! none is made and that is counted.

mod cpu;

use glam::{Vec2, Vec4};
use splashdown_gpu::{PassDesc, read, uniform, wgsl, write};

use super::{FLOW, Nozzle};
use crate::cells::{GRID, Grid, ROWS};
use crate::state::{PARAMS, Params, STATE};

/// See the module.
pub static EMIT: PassDesc = PassDesc {
    label: "flow.emit",
    wgsl: include_str!("emit.wgsl"),
    imports: &[wgsl::INDEX, STATE, PARAMS, GRID, ROWS, FLOW],
    entry: "emit",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: &[
        uniform::<Params>("params"),
        uniform::<Grid>("grid"),
        read::<u32>("cell_start"),
        read::<Nozzle>("nozzles"),
        read::<Vec4>("points"),
        write::<u32>("schedules"),
        write::<Vec4>("positions"),
        write::<Vec4>("velocities"),
        write::<u32>("ids"),
        write::<Vec2>("densities"),
    ],
    cpu: cpu::emit,
};
