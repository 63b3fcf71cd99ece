#import sph/params
#import sph/solve
#import sph/grid
#import sph/rows
#import sph/step_counters

#bindings

const GROUP: f32 = 64.0; // particles per sum
const LARGEST_IN_GROUP: f32 = 5.0; // the mean residual of a group may be this many times the tolerance
const LARGEST_DISPLACEMENT: f32 = 0.1; // see decide/mod.rs
const SHORTENED_DISPLACEMENT: f32 = 0.05;
const LEAST_PART: f32 = 0.1;

var<workgroup> sums: array<vec4<f32>, 256>;
var<workgroup> impulse_sums: array<vec4<f32>, 256>;
var<workgroup> worst_sums: array<f32, 256>;
var<workgroup> has_stopped: u32;

// The part of the tolerance that deep water needs; see decide/cpu.rs.
fn strictness(n: f32, pressure2: f32, speed2: f32) -> f32 {
    let layer = length(params.gravity) * params.particle_spacing;
    var depth = pow(n, 1.0 / 3.0);
    if (layer > 0.0 && params.compressibility > 0.0) {
        depth = sqrt(3.0 * pressure2) / layer;
    }
    depth = max(depth, 5.0);
    let moved = sqrt(speed2) * state.dt / params.particle_spacing;
    let shallow = 5.0 / depth;
    return clamp(max(shallow * shallow, 100.0 * moved / depth), 0.02, 1.0);
}

fn next_iteration(total: vec4<f32>, impulse: vec4<f32>, worst: f32, n: f32) {
    let error = total.x / n;
    if (solve.iteration == 0u) {
        state.compression += total.z / n;
    }
    if (is_measuring(solve.iteration)) {
        let mean = total.w / n;
        // Zero for NaN.
        solve.mean_excess = select(0.0, clamp(mean, 0.0, params.accepted_excess), mean < 1e30);
        solve.iteration = 1u;
        return;
    }
    let measuring = select(0u, 1u, params.accepted_excess > 0.0);
    solve.iteration += 1u;
    // False for NaN.
    let is_valid = error < 1e30;
    let has_converged = is_valid && error <= params.tolerance;
    let part = strictness(n, impulse.y / n, impulse.z / n);
    let is_even = worst <= LARGEST_IN_GROUP * params.tolerance;
    let is_enough = is_even && error <= params.tolerance * part;
    if ((has_converged && is_enough) || solve.iteration >= params.max_iterations) {
        solve.stopped = 1u;
        let work = impulse.x + compressibility_in(state) * impulse.y;
        solve.scale = clamp(1.0 + total.w / max(work, 1e-30), 0.5, 1.1);
        let fastest = state.max_speed * state.dt / params.particle_spacing;
        let late = part * (f32(solve.iteration - measuring) - 3.0) / 8.0;
        solve.renewal = select(clamp(max(fastest, late), 0.02, 1.0), 1.0, params.implicit_viscosity > 0.0);
        solve.warm_start = select(0.5, 1.0, has_converged);
        let displaced = sqrt(impulse.x / n) * state.dt / params.particle_spacing;
        if (has_converged && displaced > LARGEST_DISPLACEMENT && params.implicit_viscosity == 0.0) {
            solve.advanced_part = max(SHORTENED_DISPLACEMENT / displaced, LEAST_PART);
            state.dt *= solve.advanced_part;
        }
        if (!has_converged) {
            counters[COUNTER_UNCONVERGED] += 1u;
            counters[COUNTER_SHORTEN] = 1u;
        }
        state.iterations += solve.iteration;
        state.most_iterations = max(state.most_iterations, solve.iteration);
        state.residual = max(state.residual, error);
        return;
    }
    if (!is_valid || error > 4.0 * solve.best) {
        solve.relaxation = max(0.5 * solve.relaxation, params.relaxation / 12.0);
        solve.beta = 0.0;
        solve.best = error;
    } else {
        let restarts = solve.iteration == 1u + measuring || total.y > solve.change;
        solve.beta = select(total.y / max(solve.change, 1e-37), 0.0, restarts);
        solve.best = min(solve.best, error);
    }
    solve.change = total.y;
}

@compute @workgroup_size(256)
fn implicit_decide(@builtin(local_invocation_index) local: u32) {
    if (local == 0u) {
        has_stopped = solve.stopped;
    }
    if (workgroupUniformLoad(&has_stopped) != 0u) {
        return;
    }
    let n = active_count();
    let groups = (n + 63u) / 64u;
    var own = vec4(0.0);
    var impulse = vec4(0.0);
    var worst = 0.0;
    for (var g = local; g < groups; g += 1024u) {
        // Four at a time, so that they are loaded together. A group behind the last counts as zero.
        let there = vec4(g + 256u, g + 512u, g + 768u, g) < vec4(groups);
        let next = min(vec4(g + 256u, g + 512u, g + 768u, g), vec4(groups - 1u));
        let a = residuals[next.w];
        let b = select(vec4(0.0), residuals[next.x], there.x);
        let c = select(vec4(0.0), residuals[next.y], there.y);
        let d = select(vec4(0.0), residuals[next.z], there.z);
        own += (a + b) + (c + d);
        worst = max(worst, max(max(a.x, b.x), max(c.x, d.x)));
        impulse += impulses[next.w];
        impulse += select(vec4(0.0), impulses[next.x], there.x);
        impulse += select(vec4(0.0), impulses[next.y], there.y);
        impulse += select(vec4(0.0), impulses[next.z], there.z);
    }
    sums[local] = own;
    impulse_sums[local] = impulse;
    worst_sums[local] = worst;
    workgroupBarrier();
    for (var half = 128u; half > 0u; half /= 2u) {
        if (local < half) {
            sums[local] += sums[local + half];
            impulse_sums[local] += impulse_sums[local + half];
            worst_sums[local] = max(worst_sums[local], worst_sums[local + half]);
        }
        workgroupBarrier();
    }
    if (local == 0u && state.run_count != 0u) {
        next_iteration(sums[0], impulse_sums[0], worst_sums[0] / GROUP, max(f32(n), 1.0));
    }
}
