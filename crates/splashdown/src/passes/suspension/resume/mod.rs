//! Continues a suspended step before the iterations of the solver that has not stopped, or allows steps again that were
//! held (see the [module](super)).

use splashdown_gpu::scan::{self, ScanParams};
use splashdown_gpu::{PassDesc, bindings};

use crate::cells::{GRID, Grid};
use crate::state::{
    PARAMS, Params, SOLVE, STATE, SUSPENSION, SolveState, StepState, Suspension, VISCOUS, ViscousState,
};

bindings! {
    /// The buffers of `resume.wgsl`.
    pub(super) struct ResumeBindings {
        params: uniform Params,
        grid: uniform Grid,
        solve: uniform SolveState,
        viscous: uniform ViscousState,
        suspension: read Suspension,
        cell_start: write [u32],
        scan_params: write ScanParams,
        state: write StepState,
    }
}

/// Before the iterations of the pressure.
pub static PRESSURE: PassDesc = PassDesc {
    label: "suspension.resume.pressure",
    wgsl: include_str!("resume.wgsl"),
    imports: &[scan::PARAMS, PARAMS, STATE, SOLVE, VISCOUS, GRID, SUSPENSION],
    entry: "resume",
    workgroup_size: [1, 1, 1],
    constants: &[("OF", 0.0)],
    bindings: ResumeBindings::LIST,
    cpu: |_, slots| {
        let buffers = ResumeBindings::from(slots);
        let is_due = buffers.state.done == StepState::SUSPENDED && buffers.solve.stopped == 0;
        resume(buffers, is_due);
    },
};

/// Before the iterations of the viscosity.
pub static VISCOSITY: PassDesc = PassDesc {
    label: "suspension.resume.viscosity",
    constants: &[("OF", 1.0)],
    cpu: |_, slots| {
        let buffers = ResumeBindings::from(slots);
        let is_due = buffers.state.done == StepState::SUSPENDED && buffers.viscous.stopped == 0;
        resume(buffers, is_due);
    },
    ..PRESSURE
};

/// After a step that was held.
pub static RELEASE: PassDesc = PassDesc {
    label: "suspension.release",
    constants: &[("OF", 2.0)],
    cpu: |_, slots| {
        let buffers = ResumeBindings::from(slots);
        let is_due = buffers.state.done == StepState::HELD;
        resume(buffers, is_due);
    },
    ..PRESSURE
};

fn resume(buffers: ResumeBindings<'_>, is_due: bool) {
    let ResumeBindings { params, grid, suspension, cell_start, scan_params, state, .. } = buffers;
    if !is_due {
        return;
    }
    let cells = grid.cell_count as usize;
    cell_start[cells] = suspension.cell_particles;
    cell_start[cells + 1] = suspension.all_particles;
    *scan_params = ScanParams { len: suspension.scan_len, blocks: suspension.scan_blocks };
    state.run_count = params.particle_count;
    state.done = 0;
}
