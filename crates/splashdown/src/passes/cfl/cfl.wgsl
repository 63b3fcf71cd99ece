#import sph/params
#import sph/tally

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read_write> state: StepState;
@group(0) @binding(2) var<storage, read_write> tally: array<u32>;

@compute @workgroup_size(1)
fn cfl() {
    // A frame that is complete. Without any particle time goes on.
    if (state.done != 0u && state.run_count == 0u) {
        return;
    }
    let speed = bitcast<f32>(tally[TALLY_MAX_SPEED]);
    let acceleration = bitcast<f32>(tally[TALLY_MAX_ACCELERATION]);
    let excess = bitcast<f32>(tally[TALLY_MAX_EXCESS]);
    tally[TALLY_MAX_SPEED] = 0u;
    tally[TALLY_MAX_ACCELERATION] = 0u;
    tally[TALLY_MAX_EXCESS] = 0u;

    let h = 0.5 * params.support_radius;
    let c = params.cfl_factor;
    var stable = min(1.1 * state.stable_dt, params.max_dt);
    stable = min(stable, c * h / (params.sound_speed + speed));
    stable = min(stable, c * sqrt(h / max(acceleration, 1e-20)));
    stable = min(stable, c * 0.4 * params.particle_spacing / max(speed, 1e-20));
    stable = min(stable, 0.125 * h * h / max(params.viscosity, 1e-20));
    if (stable < params.min_dt) {
        stable = params.min_dt;
        state.too_small = 1u;
    }
    let remaining = state.remaining - state.dt;
    state.time += state.dt;
    state.steps += 1u;
    state.stable_dt = stable;
    state.max_speed = speed;
    state.max_acceleration = acceleration;
    state.density_error = max(state.density_error, excess);
    state.remaining = remaining;
    if (remaining <= 1e-6 * state.frame_duration) {
        state.done = 1u;
        state.run_count = 0u;
    } else if (remaining < 2.0 * stable) {
        state.dt = select(0.5 * remaining, remaining, remaining <= stable);
    } else {
        state.dt = stable;
    }
}
