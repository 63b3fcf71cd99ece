#import sph/cell_counts
#import sph/boundary_law
// The integration of one particle; needs `params`, `grid`, `state`, `positions`, `velocities`, `cell_counts` and `counters`,
// the last two atomic. See passes/integrate.

// Maxima of the workgroup, as bits of floats: speed, acceleration, excess of density.
var<workgroup> highest: array<atomic<u32>, 3>;

fn begin_advance(local: u32) {
    if (local < 3u) {
        atomicStore(&highest[local], 0u);
    }
    workgroupBarrier();
}

fn end_advance(i: u32, local: u32) {
    workgroupBarrier();
    if (local < 3u) {
        atomicMax(&counters[COUNTER_MAX_SPEED + local], atomicLoad(&highest[local]));
    }
    if (i == 0u && state.done == 0u) {
        atomicStore(&counters[COUNTER_MOVED], 1u);
    }
}

fn is_closed(bit: u32) -> bool {
    return ((params.closed >> bit) & 1u) == 1u;
}

fn raise(k: u32, value: f32) {
    atomicMax(&highest[k], bitcast<u32>(value));
}

// What a step does to a particle; see Change in advance.rs.
struct Change {
    acceleration: vec3<f32>,
    shift: vec3<f32>,
    density: f32,
}

// Integrates particle `i` and returns its new cell.
fn advance(i: u32, p: vec4<f32>, old: vec4<f32>, change: Change) -> u32 {
    let a = change.acceleration;
    let rho = change.density;
    if (p.w != 0.0) {
        positions[i] = p;
        velocities[i] = old;
        return grid.cell_count;
    }
    let dt = state.dt;
    var v = old.xyz + dt * a;
    let step = length(v) * dt;
    let most = params.longest_motion * params.particle_spacing;
    if (step > most) {
        v *= most / step;
        atomicAdd(&counters[COUNTER_LIMITED], 1u);
    }
    // A wall limits the velocity, and its sum with the shifting.
    let most_shift = 0.1 * params.particle_spacing / dt;
    var motion = v + change.shift * min(1.0, most_shift / max(length(change.shift), 1e-20));
    for (var axis = 0u; axis < 3u; axis++) {
        if (is_closed(2u * axis)) {
            let slowest = -contact_speed(p[axis] - params.domain_min[axis], dt);
            v[axis] = max(v[axis], slowest);
            motion[axis] = max(motion[axis], slowest);
        }
        if (is_closed(2u * axis + 1u)) {
            let fastest = contact_speed(params.domain_max[axis] - p[axis], dt);
            v[axis] = min(v[axis], fastest);
            motion[axis] = min(motion[axis], fastest);
        }
    }
    var x = p.xyz + dt * motion;
    // `max` and `min` may ignore a NaN operand, so the acceleration and the density are tested too.
    if (!is_finite(x) || !is_finite(a) || !is_finite(vec3(rho))) {
        positions[i] = vec4(p.xyz, DEAD_NON_FINITE);
        velocities[i] = vec4(0.0, 0.0, 0.0, params.rest_density);
        atomicAdd(&counters[COUNTER_NON_FINITE], 1u);
        return grid.cell_count;
    }
    for (var axis = 0u; axis < 3u; axis++) {
        if ((is_closed(2u * axis) && x[axis] < params.domain_min[axis])
            || (is_closed(2u * axis + 1u) && x[axis] > params.domain_max[axis])) {
            x[axis] = clamp(x[axis], params.domain_min[axis], params.domain_max[axis]);
            v[axis] = 0.0;
            atomicAdd(&counters[COUNTER_CORRECTIONS], 1u);
        }
    }
    raise(0u, length(v));
    raise(1u, length(a));
    raise(2u, max(rho / params.rest_density - 1.0, 0.0));
    velocities[i] = vec4(v, rho);
    if (is_outside(x)) {
        positions[i] = vec4(x, DEAD_ESCAPED);
        atomicAdd(&counters[COUNTER_ESCAPED], 1u);
        return grid.cell_count;
    }
    positions[i] = vec4(x, 0.0);
    return cell_of(x);
}
