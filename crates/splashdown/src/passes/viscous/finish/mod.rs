//! The accelerations by all forces but pressure (see the [module](super)).

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, bindings, wgsl};

use crate::cells::{GRID, Grid, ROWS};
use crate::state::{STATE, StepState, VISCOUS, ViscousState};

bindings! {
    /// The buffers of `viscous_finish.wgsl`.
    pub(super) struct FinishBindings {
        grid: uniform Grid,
        state: uniform StepState,
        viscous: uniform ViscousState,
        cell_start: read [u32],
        sorted_velocities: read [Vec4],
        viscous_residuals: read [Vec4],
        predicted: read [Vec4],
        iterates: read [Vec4],
        accelerations: write [Vec4],
    }
}

/// See the module.
pub static FINISH: PassDesc = PassDesc {
    label: "viscous.finish",
    wgsl: include_str!("viscous_finish.wgsl"),
    imports: &[wgsl::INDEX, STATE, VISCOUS, GRID, ROWS],
    entry: "viscous_finish",
    workgroup_size: [256, 1, 1],
    constants: &[],
    bindings: FinishBindings::LIST,
    cpu: |_, slots| cpu::finish(slots.into()),
};
