//! Changes the velocities along the next direction, and the residual with them (see the [module](super)).

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, bindings, wgsl};

use crate::cells::{GRID, Grid, ROWS};
use crate::state::{STATE, StepState, VISCOUS, ViscousState};

bindings! {
    /// The buffers of `viscous_update.wgsl`.
    pub(super) struct UpdateBindings {
        grid: uniform Grid,
        state: uniform StepState,
        viscous: uniform ViscousState,
        cell_start: read [u32],
        sorted_velocities: read [Vec4],
        viscous_products: read [Vec4],
        viscous_residuals: write [Vec4],
        viscous_directions: write [Vec4],
        viscous_images: write [Vec4],
        predicted: write [Vec4],
    }
}

/// See the module.
pub static UPDATE: PassDesc = PassDesc {
    label: "viscous.update",
    wgsl: include_str!("viscous_update.wgsl"),
    imports: &[wgsl::INDEX, STATE, VISCOUS, GRID, ROWS],
    entry: "viscous_update",
    workgroup_size: [256, 1, 1],
    constants: &[],
    bindings: UpdateBindings::LIST,
    cpu: |_, slots| cpu::update(slots.into()),
};
