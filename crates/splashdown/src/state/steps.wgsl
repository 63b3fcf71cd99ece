#import sph/step_counters
// The end of a step; needs `params`, `state` and `counters` (not atomic). See state/end_step.

// The longest step with a pressure over the rest density; see end_step/cpu.rs.
fn pressure_limit(pressure: f32) -> f32 {
    let spacing = params.particle_spacing;
    let undamped = 0.5 * spacing / sqrt(max(pressure, 1e-20));
    let damping = 0.25 * undamped * 3.0 * params.implicit_viscosity / (spacing * spacing);
    return undamped * (damping + sqrt(damping * damping + 1.0));
}

fn finish_step() {
    if (counters[COUNTER_MOVED] == 0u) {
        return;
    }
    let speed = bitcast<f32>(counters[COUNTER_MAX_SPEED]);
    let acceleration = bitcast<f32>(counters[COUNTER_MAX_ACCELERATION]);
    let excess = bitcast<f32>(counters[COUNTER_MAX_EXCESS]);
    counters[COUNTER_MOVED] = 0u;
    counters[COUNTER_MAX_SPEED] = 0u;
    counters[COUNTER_MAX_ACCELERATION] = 0u;
    counters[COUNTER_MAX_EXCESS] = 0u;

    let is_slow = counters[COUNTER_SHORTEN] != 0u;
    counters[COUNTER_SHORTEN] = 0u;
    let pressure = bitcast<f32>(counters[COUNTER_MAX_PRESSURE]);
    counters[COUNTER_MAX_PRESSURE] = 0u;
    var stable = longest_step(max(speed, state.body_speed), acceleration, excess);
    if (params.is_implicit == 1u) {
        stable = min(stable, select(1.5 * state.stable_dt, 0.7 * min(state.stable_dt, state.dt), is_slow));
        stable = min(stable, pressure_limit(pressure));
    } else {
        stable = min(stable, 1.1 * state.stable_dt);
    }
    if (stable < params.min_dt) {
        stable = params.min_dt;
        state.too_small = 1u;
    }
    state.steps += 1u;
    state.stable_dt = stable;
    state.max_speed = speed;
    state.max_acceleration = acceleration;
    state.density_error = max(state.density_error, excess);
    if (is_last_step(state.dt, state.remaining)) {
        state.remaining = 0.0;
        state.done = COMPLETE;
        state.run_count = 0u;
    } else {
        state.remaining -= state.dt;
        state.dt = step_length(stable, state.remaining, false);
    }
    state.time = state.frame_start + (state.frame_duration - state.remaining);
}
