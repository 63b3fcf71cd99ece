//! Adds the acceleration of the mouse force: see [`MouseForce`].

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, bindings, wgsl};

use super::{MOUSE_FORCE, MouseForce};
use crate::cells::{GRID, Grid};
use crate::state::{STATE, StepState};

bindings! {
    /// The buffers of `apply.wgsl`.
    pub(super) struct ApplyBindings {
        grid: uniform Grid,
        state: read StepState,
        cell_start: read [u32],
        mouse_force: read MouseForce,
        sorted_positions: read [Vec4],
        sorted_velocities: read [Vec4],
        accelerations: write [Vec4],
    }
}

/// See the module.
pub static APPLY: PassDesc = PassDesc {
    label: "mouse_force.apply",
    wgsl: include_str!("apply.wgsl"),
    imports: &[wgsl::INDEX, STATE, GRID, MOUSE_FORCE],
    entry: "apply",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: ApplyBindings::LIST,
    cpu: |_, slots| cpu::apply(slots.into()),
};
