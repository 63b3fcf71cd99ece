//! Begins the iterations of a step, with the pressures with which the pressure solver will start; after the end of a frame
//! there are none.

use glam::Vec4;
use rayon::prelude::*;
use splashdown_gpu::{PassDesc, bindings, wgsl};

use crate::cells::{GRID, Grid, ROWS};
use crate::state::{STATE, StepState, VISCOUS, ViscousState};

bindings! {
    /// The buffers of `viscous_begin.wgsl`.
    pub(super) struct BeginBindings {
        grid: uniform Grid,
        state: uniform StepState,
        cell_start: read [u32],
        sorted_pressures: read [f32],
        viscous: write ViscousState,
        iterates: write [Vec4],
    }
}

/// See the module.
pub static BEGIN: PassDesc = PassDesc {
    label: "viscous.begin",
    wgsl: include_str!("viscous_begin.wgsl"),
    imports: &[wgsl::INDEX, STATE, VISCOUS, GRID, ROWS],
    entry: "viscous_begin",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: BeginBindings::LIST,
    cpu: |_, slots| {
        let BeginBindings { grid, state, cell_start, sorted_pressures, viscous, iterates } = slots.into();
        if state.done != StepState::SUSPENDED {
            *viscous = ViscousState::new(state.run_count == 0);
        }
        let active = cell_start[grid.cell_count as usize] as usize;
        let starts = iterates[..active].par_iter_mut().zip(&sorted_pressures[..active]);
        starts.with_min_len(4096).for_each(|(iterate, p)| *iterate = Vec4::new(p.max(0.0), 0.0, 0.0, 0.0));
    },
};
