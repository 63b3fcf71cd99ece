use super::EndStepBindings;
use crate::state::{Params, StepCounters, StepState};

pub(super) fn end_step(buffers: EndStepBindings<'_>) {
    let EndStepBindings { params, state, counters } = buffers;
    finish_step(params, state, counters);
}

/// Ends the previous step, unless it has ended already.
pub(crate) fn finish_step(params: &Params, state: &mut StepState, counters: &mut [u32]) {
    if std::mem::take(&mut counters[StepCounters::MOVED]) == 0 {
        return;
    }
    let mut take = |word: usize| f32::from_bits(std::mem::take(&mut counters[word]));
    let [speed, acceleration, excess] =
        [StepCounters::MAX_SPEED, StepCounters::MAX_ACCELERATION, StepCounters::MAX_EXCESS].map(&mut take);

    let is_slow = std::mem::take(&mut counters[StepCounters::SHORTEN]) != 0;
    let pressure = f32::from_bits(std::mem::take(&mut counters[StepCounters::MAX_PRESSURE]));
    let grown = if params.is_implicit == 1 {
        let most = if is_slow { 0.7 * state.stable_dt.min(state.dt) } else { 1.5 * state.stable_dt };
        most.min(pressure_limit(params, pressure))
    } else {
        1.1 * state.stable_dt
    };
    let mut stable = grown.min(params.longest_step(speed.max(state.body_speed), acceleration, excess));
    if stable < params.min_dt {
        stable = params.min_dt;
        state.too_small = 1;
    }
    state.steps += 1;
    state.stable_dt = stable;
    state.max_speed = speed;
    state.max_acceleration = acceleration;
    state.density_error = state.density_error.max(excess);
    if state.is_last_step() {
        state.remaining = 0.0;
        state.done = StepState::COMPLETE;
        state.run_count = 0;
    } else {
        state.remaining -= state.dt;
        state.dt = params.step_length(stable, state.remaining, false);
    }
    state.time = state.frame_start + (state.frame_duration - state.remaining);
}

/// The longest step in s with a pressure over the rest density. A particle that is displaced across its neighbours oscillates
/// by the pressure at the rate w, and a step of 2 / w is the longest stable one. An implicit viscosity damps this motion at
/// a rate g, and dt^2 w^2 = 4 + 2 g dt is stable. A lone particle is damped at 6 nu / spacing^2; half of it counts.
fn pressure_limit(params: &Params, pressure: f32) -> f32 {
    let spacing = params.particle_spacing;
    let undamped = 0.5 * spacing / pressure.max(1e-20).sqrt();
    let damping = 0.25 * undamped * 3.0 * params.implicit_viscosity / (spacing * spacing);
    undamped * (damping + (damping * damping + 1.0).sqrt())
}
