use splashdown_gpu::{CpuWork, Slot};

use crate::state::{Params, StepState};

pub(super) fn begin(_: CpuWork, slots: &mut [Slot<'_>]) {
    let [params, duration, state] = slots else { unreachable!() };
    let length = duration.read::<f32>()[0];
    let state = &mut state.write::<StepState>()[0];
    state.frame_duration = length;
    state.remaining = length;
    state.dt = StepState::step_length(state.stable_dt, length);
    state.done = 0;
    state.run_count = params.get::<Params>().particle_count;
    state.steps = 0;
    state.too_small = 0;
    state.density_error = 0.0;
}
