use glam::Vec4;

use super::super::GROUP;
use super::DecideBindings;
use crate::state::StepCounters;

pub(super) fn decide(buffers: DecideBindings<'_>) {
    let DecideBindings { params, grid, cell_start, residuals, impulses, state, viscous, counters } = buffers;
    if viscous.stopped != 0 || state.run_count == 0 {
        return;
    }
    let n = cell_start[grid.cell_count as usize] as usize;
    let total: Vec4 = residuals[..n.div_ceil(GROUP)].iter().sum();
    let impulse: f32 = impulses[..n.div_ceil(GROUP)].iter().map(|sum| sum.x).sum();
    let n = (n as f32).max(1.0);
    let residual = (total.z / n).sqrt();
    if viscous.iteration == 0 {
        viscous.reference = ((impulse + total.w) / n).sqrt();
        viscous.target_residual = params.viscous_tolerance * viscous.reference + 1e-6 * state.max_speed;
    }
    viscous.iteration += 1;
    // False for NaN.
    let has_converged = residual <= viscous.target_residual;
    let is_valid = residual < 1e30;
    if has_converged || !is_valid || viscous.iteration >= params.most_viscous_iterations {
        viscous.stopped = 1;
        if !has_converged {
            counters[StepCounters::VISCOUS_UNCONVERGED] += 1;
            counters[StepCounters::SHORTEN] = 1;
        }
        state.viscous_iterations += viscous.iteration;
        state.most_viscous_iterations = state.most_viscous_iterations.max(viscous.iteration);
        state.viscous_residual = state.viscous_residual.max(residual / viscous.reference.max(1e-30));
        return;
    }
    let (gamma, delta) = (total.x, total.y);
    let (mut beta, mut denominator) = (0.0, delta);
    if viscous.updates > 0 {
        let next = gamma / viscous.gamma.max(1e-37);
        let conjugate = delta - next * gamma / viscous.alpha;
        // Rounding has consumed the difference: the directions restart.
        if conjugate > 1e-3 * delta {
            (beta, denominator) = (next, conjugate);
        }
    }
    viscous.beta = beta;
    viscous.alpha = gamma / denominator.max(1e-37);
    viscous.gamma = gamma;
    viscous.updates += 1;
}
