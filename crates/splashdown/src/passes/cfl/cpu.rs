use splashdown_gpu::{CpuWork, Slot};

use crate::passes::{Params, StepState, Tally};

pub(super) fn cfl(_: CpuWork, slots: &mut [Slot<'_>]) {
    let [params, state, tally] = slots else { unreachable!() };
    let params = params.get::<Params>();
    let state = &mut state.write::<StepState>()[0];
    if state.done != 0 && state.run_count == 0 {
        return;
    }
    let tally = tally.write::<u32>();
    let mut take = |word: usize| f32::from_bits(std::mem::take(&mut tally[word]));
    let [speed, acceleration, excess] =
        [Tally::MAX_SPEED, Tally::MAX_ACCELERATION, Tally::MAX_EXCESS].map(&mut take);

    let h = 0.5 * params.support_radius;
    let c = params.cfl_factor;
    let mut stable = (1.1 * state.stable_dt)
        .min(params.max_dt)
        .min(c * h / (params.sound_speed + speed))
        .min(c * (h / acceleration.max(1e-20)).sqrt())
        .min(c * 0.4 * params.particle_spacing / speed.max(1e-20))
        .min(0.125 * h * h / params.viscosity.max(1e-20));
    if stable < params.min_dt {
        stable = params.min_dt;
        state.too_small = 1;
    }
    let remaining = state.remaining - state.dt;
    state.time += state.dt;
    state.steps += 1;
    state.stable_dt = stable;
    state.max_speed = speed;
    state.max_acceleration = acceleration;
    state.density_error = state.density_error.max(excess);
    state.remaining = remaining;
    if remaining <= 1e-6 * state.frame_duration {
        state.done = 1;
        state.run_count = 0;
    } else if remaining < 2.0 * stable {
        state.dt = if remaining <= stable { remaining } else { 0.5 * remaining };
    } else {
        state.dt = stable;
    }
}
