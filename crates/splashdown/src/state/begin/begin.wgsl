#import sph/params

#bindings

@compute @workgroup_size(1)
fn begin() {
    let length = frame_input[0];
    state.frame_duration = length;
    state.frame_start = frame_input[1];
    state.body_speed = frame_input[2];
    state.time = state.frame_start;
    state.remaining = length;
    // The parameters may have changed since the last step.
    let longest = longest_step(max(state.max_speed, state.body_speed), state.max_acceleration, 0.0);
    state.stable_dt = max(min(state.stable_dt, longest), params.min_dt);
    state.dt = step_length(state.stable_dt, length, true);
    state.done = 0u;
    state.run_count = params.particle_count;
    state.steps = 0u;
    state.too_small = 0u;
    state.density_error = 0.0;
    state.iterations = 0u;
    state.most_iterations = 0u;
    state.residual = 0.0;
    state.compression = 0.0;
    state.viscous_iterations = 0u;
    state.most_viscous_iterations = 0u;
    state.viscous_residual = 0.0;
}
