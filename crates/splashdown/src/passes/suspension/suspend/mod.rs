//! Suspends a step whose pressure or viscosity needs further iterations (see the [module](super)).

use splashdown_gpu::scan::{self, ScanParams};
use splashdown_gpu::{PassDesc, bindings};

use crate::cells::{GRID, Grid};
use crate::state::{SOLVE, STATE, SUSPENSION, SolveState, StepState, Suspension, VISCOUS, ViscousState};

bindings! {
    /// The buffers of `suspend.wgsl`.
    pub(super) struct SuspendBindings {
        grid: uniform Grid,
        solve: uniform SolveState,
        viscous: uniform ViscousState,
        cell_start: write [u32],
        scan_params: write ScanParams,
        state: write StepState,
        suspension: write Suspension,
    }
}

/// See the module.
pub static SUSPEND: PassDesc = PassDesc {
    label: "suspension.suspend",
    wgsl: include_str!("suspend.wgsl"),
    imports: &[scan::PARAMS, STATE, SOLVE, VISCOUS, GRID, SUSPENSION],
    entry: "suspend",
    workgroup_size: [1, 1, 1],
    constants: &[],
    bindings: SuspendBindings::LIST,
    cpu: |_, slots| suspend(slots.into()),
};

fn suspend(buffers: SuspendBindings<'_>) {
    let SuspendBindings { grid, solve, viscous, cell_start, scan_params, state, suspension } = buffers;
    if state.run_count == 0 || (solve.stopped != 0 && viscous.stopped != 0) {
        return;
    }
    let cells = grid.cell_count as usize;
    *suspension = Suspension {
        cell_particles: std::mem::take(&mut cell_start[cells]),
        all_particles: std::mem::take(&mut cell_start[cells + 1]),
        scan_len: std::mem::take(&mut scan_params.len),
        scan_blocks: std::mem::take(&mut scan_params.blocks),
        count: suspension.count + 1,
    };
    state.run_count = 0;
    state.done = StepState::SUSPENDED;
}
