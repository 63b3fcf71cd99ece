use super::BeginBindings;

pub(super) fn begin(buffers: BeginBindings<'_>) {
    let BeginBindings { params, frame_input, state } = buffers;
    let length = frame_input[0];
    state.frame_duration = length;
    state.frame_start = frame_input[1];
    state.body_speed = frame_input[2];
    state.time = state.frame_start;
    state.remaining = length;
    // The parameters may have changed since the last step.
    let longest = params.longest_step(state.max_speed.max(state.body_speed), state.max_acceleration, 0.0);
    state.stable_dt = state.stable_dt.min(longest).max(params.min_dt);
    state.dt = params.step_length(state.stable_dt, length, true);
    state.done = 0;
    state.run_count = params.particle_count;
    state.steps = 0;
    state.too_small = 0;
    state.density_error = 0.0;
    state.iterations = 0;
    state.most_iterations = 0;
    state.residual = 0.0;
    state.compression = 0.0;
    state.viscous_iterations = 0;
    state.most_viscous_iterations = 0;
    state.viscous_residual = 0.0;
}
