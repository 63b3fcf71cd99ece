#import sph/params
#import sph/viscous_state
#import sph/grid
#import sph/rows
#import sph/step_counters

#bindings

var<workgroup> sums: array<vec4<f32>, 256>;

// `total`: r.z, z.A z, r.r, and the sum of z.z and the squared change of the velocity by all other forces.
fn next_iteration(total: vec4<f32>, n: f32) {
    let residual = sqrt(total.z / n);
    if (viscous.iteration == 0u) {
        viscous.reference = sqrt(total.w / n);
        viscous.target_residual = params.viscous_tolerance * viscous.reference + 1e-6 * state.max_speed;
    }
    viscous.iteration += 1u;
    // False for NaN.
    let has_converged = residual <= viscous.target_residual;
    if (has_converged || !(residual < 1e30) || viscous.iteration >= params.most_viscous_iterations) {
        viscous.stopped = 1u;
        if (!has_converged) {
            counters[COUNTER_VISCOUS_UNCONVERGED] += 1u;
            counters[COUNTER_SHORTEN] = 1u;
        }
        state.viscous_iterations += viscous.iteration;
        state.most_viscous_iterations = max(state.most_viscous_iterations, viscous.iteration);
        state.viscous_residual = max(state.viscous_residual, residual / max(viscous.reference, 1e-30));
        return;
    }
    var beta = 0.0;
    var denominator = total.y;
    if (viscous.updates > 0u) {
        beta = total.x / max(viscous.gamma, 1e-37);
        denominator = total.y - beta * total.x / viscous.alpha;
        if (!(denominator > 1e-3 * total.y)) {
            beta = 0.0;
            denominator = total.y;
        }
    }
    viscous.beta = beta;
    viscous.alpha = total.x / max(denominator, 1e-37);
    viscous.gamma = total.x;
    viscous.updates += 1u;
}

@compute @workgroup_size(256)
fn viscous_decide(@builtin(local_invocation_index) local: u32) {
    let n = active_count();
    var own = vec4(0.0);
    for (var g = local; g < (n + 63u) / 64u; g += 256u) {
        own += residuals[g] + vec4(0.0, 0.0, 0.0, impulses[g].x);
    }
    sums[local] = own;
    workgroupBarrier();
    for (var half = 128u; half > 0u; half /= 2u) {
        if (local < half) {
            sums[local] += sums[local + half];
        }
        workgroupBarrier();
    }
    if (local == 0u && viscous.stopped == 0u && state.run_count != 0u) {
        next_iteration(sums[0], max(f32(n), 1.0));
    }
}
