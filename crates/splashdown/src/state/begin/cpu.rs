use super::BeginBindings;

pub(super) fn begin(buffers: BeginBindings<'_>) {
    let BeginBindings { params, duration, state } = buffers;
    let length = duration[0];
    state.frame_duration = length;
    state.remaining = length;
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
