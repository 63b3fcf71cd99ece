//! Suspends a step whose pressure or viscosity needs further iterations, or keeps the next step from beginning (see the
//! [module](super)).

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

/// After the iterations of the pressure.
pub static PRESSURE: PassDesc = PassDesc {
    label: "suspension.suspend.pressure",
    wgsl: include_str!("suspend.wgsl"),
    imports: &[scan::PARAMS, STATE, SOLVE, VISCOUS, GRID, SUSPENSION],
    entry: "suspend",
    workgroup_size: [1, 1, 1],
    constants: &[("OF", 0.0)],
    bindings: SuspendBindings::LIST,
    cpu: |_, slots| {
        let buffers = SuspendBindings::from(slots);
        let has_stopped = buffers.solve.stopped != 0;
        suspend(buffers, has_stopped, StepState::SUSPENDED);
    },
};

/// After the iterations of the viscosity.
pub static VISCOSITY: PassDesc = PassDesc {
    label: "suspension.suspend.viscosity",
    constants: &[("OF", 1.0)],
    cpu: |_, slots| {
        let buffers = SuspendBindings::from(slots);
        let has_stopped = buffers.viscous.stopped != 0;
        suspend(buffers, has_stopped, StepState::SUSPENDED);
    },
    ..PRESSURE
};

/// Before a step that must not begin.
pub static HOLD: PassDesc = PassDesc {
    label: "suspension.hold",
    constants: &[("OF", 2.0)],
    cpu: |_, slots| suspend(slots.into(), false, StepState::HELD),
    ..PRESSURE
};

fn suspend(buffers: SuspendBindings<'_>, has_stopped: bool, done: u32) {
    let SuspendBindings { grid, cell_start, scan_params, state, suspension, .. } = buffers;
    if state.done != 0 || has_stopped {
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
    state.done = done;
}
