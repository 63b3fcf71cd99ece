use glam::Vec4;

use super::super::{GROUP, LARGEST_IN_GROUP};
use super::{DecideBindings, LARGEST_DISPLACEMENT, LEAST_PART, SHORTENED_DISPLACEMENT};
use crate::state::{Params, StepCounters};

pub(super) fn decide(buffers: DecideBindings<'_>) {
    let DecideBindings { params, grid, cell_start, residuals, impulses, state, solve, counters } = buffers;
    if solve.stopped != 0 || state.run_count == 0 {
        return;
    }
    let n = cell_start[grid.cell_count as usize] as usize;
    let residuals = &residuals[..n.div_ceil(GROUP)];
    let total: Vec4 = residuals.iter().sum();
    let worst = residuals.iter().map(|sum| sum.x).fold(0.0, f32::max) / GROUP as f32;
    let impulses = &impulses[..n.div_ceil(GROUP)];
    let impulse: Vec4 = impulses.iter().sum();
    let n = (n as f32).max(1.0);
    let error = total.x / n;
    if solve.iteration == 0 {
        state.compression += total.z / n;
    }
    if solve.is_measuring(params) {
        let mean = total.w / n;
        // Zero for NaN.
        solve.mean_excess = if mean < 1e30 { mean.clamp(0.0, params.accepted_excess) } else { 0.0 };
        solve.iteration = 1;
        return;
    }
    let measuring = u32::from(params.accepted_excess > 0.0);
    solve.iteration += 1;
    // False for NaN.
    let is_valid = error < 1e30;
    let has_converged = is_valid && error <= params.tolerance;
    let strictness = strictness(params, state.dt, n, impulse / n);
    let is_even = worst <= LARGEST_IN_GROUP * params.tolerance;
    let is_enough = is_even && error <= params.tolerance * strictness;
    if has_converged && is_enough || solve.iteration >= params.max_iterations {
        solve.stopped = 1;
        let work = impulse.x + params.compressibility_in(state) * impulse.y;
        let scale = 1.0 + total.w / work.max(1e-30);
        solve.scale = scale.clamp(0.5, 1.1);
        let fastest = state.max_speed * state.dt / params.particle_spacing;
        let late = strictness * ((solve.iteration - measuring) as f32 - 3.0) / 8.0;
        solve.renewal =
            if params.implicit_viscosity > 0.0 { 1.0 } else { fastest.max(late).clamp(0.02, 1.0) };
        let displaced = (impulse.x / n).sqrt() * state.dt / params.particle_spacing;
        if has_converged && displaced > LARGEST_DISPLACEMENT && params.implicit_viscosity == 0.0 {
            solve.advanced_part = (SHORTENED_DISPLACEMENT / displaced).max(LEAST_PART);
            state.dt *= solve.advanced_part;
        }
        if !has_converged {
            solve.warm_start = 0.5;
            counters[StepCounters::UNCONVERGED] += 1;
            counters[StepCounters::SHORTEN] = 1;
        }
        state.iterations += solve.iteration;
        state.most_iterations = state.most_iterations.max(solve.iteration);
        state.residual = state.residual.max(error);
        return;
    }
    if !is_valid || error > 4.0 * solve.best {
        solve.relaxation = (0.5 * solve.relaxation).max(params.relaxation / 12.0);
        solve.beta = 0.0;
        solve.best = error;
    } else {
        let restarts = solve.iteration == 1 + measuring || total.y > solve.change;
        solve.beta = if restarts { 0.0 } else { total.y / solve.change.max(1e-37) };
        solve.best = solve.best.min(error);
    }
    solve.change = total.y;
}

/// The part of the tolerance that deep water needs. A residual of one sign moves the surface by the depth times the
/// residual in a step: with the default tolerance of 0.1 %, at most by a tenth of the root mean square of the motions.
/// With gravity the depth follows from the mean square of the pressure, as if the fluid were at rest; without, it is the
/// cube root of the number of particles, `n`, which is the size of a compact fluid.
fn strictness(params: &Params, dt: f32, n: f32, impulse: Vec4) -> f32 {
    let (pressure2, speed2) = (impulse.y, impulse.z);
    let layer = params.gravity.length() * params.particle_spacing;
    let has_weight = layer > 0.0 && params.compressibility > 0.0;
    let depth = if has_weight { (3.0 * pressure2).sqrt() / layer } else { n.cbrt() };
    let depth = depth.max(5.0);
    let moved = speed2.sqrt() * dt / params.particle_spacing;
    let shallow = 5.0 / depth;
    (shallow * shallow).max(100.0 * moved / depth).clamp(0.02, 1.0)
}
