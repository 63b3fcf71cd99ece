#import gpu/index
#import sph/params
#import sph/solve
#import sph/grid
#import sph/rows
#import sph/images
#import sph/candidates
#import sph/neighbours
#import sph/kernel
#import sph/group_sum

#bindings

override BODIES: u32 = 0u; // 1: bodies contribute to the density

// See the module.
const SMALLEST_SURFACE_GRADIENT: f32 = 0.3;
const LARGEST_COMPLETED: f32 = 0.02;
const LARGEST_PULLED_GRADIENT: f32 = 0.7;
const LARGEST_PULLED_DEFICIT: f32 = 0.3;
const LARGEST_HELD: f32 = 0.02;
const LARGEST_REMOVED: f32 = 0.05;
const LEAST_REMOVED: f32 = 0.002;

// See limits.rs.
struct Limits {
    least: f32,
    pushed: f32,
    pulled: f32,
}

fn removed(excess: f32) -> f32 {
    let most = max(LEAST_REMOVED, 2.0 * params.tolerance) + LARGEST_REMOVED * solve.dt_ratio * solve.dt_ratio;
    return min(excess, most);
}

fn limits_inside(excess: f32) -> Limits {
    let closed = max(state.dt * closing_rate() * excess, excess);
    let is_thin = excess < 0.0;
    return Limits(
        -tension_limit(),
        select(excess, min(closed, excess + LARGEST_HELD), is_thin),
        select(excess, closed, is_thin),
    );
}

fn residual_of(limits: Limits, k: f32, change: f32) -> f32 {
    let pushed = limits.pushed + change;
    let pulled = limits.pulled + change;
    if (k > 0.0 || (k == 0.0 && pushed > 0.0)) {
        return pushed;
    }
    return select(0.0, pulled, k < 0.0 || pulled < 0.0);
}

fn next_pressure(limits: Limits, k: f32, change: f32, diagonal: f32) -> f32 {
    let positive = k + solve.relaxation * (limits.pushed + change) / diagonal;
    let other = max(min(k + solve.relaxation * (limits.pulled + change) / diagonal, 0.0), limits.least);
    return select(other, positive, positive > 0.0);
}

// A term of the sum over the neighbours, for the velocities of the particle and of its neighbour.
fn term_of(entry: u32, x: vec3<f32>, position: vec3<f32>, u: vec3<f32>, other: vec3<f32>) -> f32 {
    let near = neighbour_of(entry, x, position);
    return kernel_g(length(near.d) / params.support_radius) * dot(near.d, u - near.sign * other);
}

// The sum over the neighbours in the rate of the density.
fn rate_of(i: u32, x: vec3<f32>, u: vec3<f32>) -> f32 {
    var sum = 0.0;
    var visit = visit_of(i, x);
    while (visit.left != 0u) {
        let four = next_four(&visit, i, x);
        // All loads precede the terms, so that they overlap.
        let j = four & vec4(INDEX);
        let a = sorted_positions[j.x].xyz;
        let b = sorted_positions[j.y].xyz;
        let c = sorted_positions[j.z].xyz;
        let d = sorted_positions[j.w].xyz;
        let u_a = predicted[j.x].xyz;
        let u_b = predicted[j.y].xyz;
        let u_c = predicted[j.z].xyz;
        let u_d = predicted[j.w].xyz;
        sum += term_of(four.x, x, a, u, u_a);
        sum += term_of(four.y, x, b, u, u_b);
        sum += term_of(four.z, x, c, u, u_c);
        sum += term_of(four.w, x, d, u, u_d);
    }
    let scale = 1.0 / params.support_radius;
    return params.summed_mass / params.rest_density * scale * scale * scale * scale * scale * sum;
}

// What a particle at the free surface lacks of the rest density, for the gradient of the sum of V W over fluid and bodies.
fn missing_density(gradient: vec3<f32>) -> f32 {
    let beyond = max(params.support_radius * length(gradient) - SMALLEST_SURFACE_GRADIENT, 0.0);
    return params.surface_completion * beyond * sqrt(beyond);
}

// Updates the iterate of a particle, and returns its contributions to the sums.
fn update(i: u32) -> vec4<f32> {
    let excess = iterates[i].w;
    let u = predicted[i].xyz;
    let k = predicted[i].w;
    if (k == NO_PRESSURE) {
        iterates[i] = vec4(vec3(0.0), excess);
        return vec4(0.0, 0.0, max(excess, 0.0), 0.0);
    }
    var rate = rate_of(i, sorted_positions[i].xyz, u);
    var gradient = stiffness[i].xyz;
    var normal = gradient;
    var is_free = true; // not next to a body
    if (BODIES == 1u) {
        let solid = solid_gradients[i];
        rate += dot(solid.xyz, u) - solid.w;
        gradient += solid.xyz;
        normal += 0.5 * solid.xyz;
        is_free = all(solid == vec4(0.0));
    }
    let complete = removed(excess) + min(missing_density(normal), max(LARGEST_COMPLETED * solve.dt_ratio - excess, 0.0));
    let is_inside = tension_limit() > 0.0 && complete > -LARGEST_PULLED_DEFICIT && is_free
        && params.support_radius * length(normal) < LARGEST_PULLED_GRADIENT;
    var limits = Limits(0.0, complete, complete);
    if (is_inside) {
        limits = limits_inside(complete);
    }
    let compressibility = compressibility_in(state);
    let change_of_density = state.dt * rate - compressibility * k - solve.mean_excess;
    let residual = residual_of(limits, k, change_of_density);
    let scale = 1.0 / params.support_radius;
    let squares = max(dot(gradient, gradient) + stiffness[i].w, 1e-6 * scale * scale);
    let diagonal = state.dt * state.dt * squares + compressibility;
    let is_first = is_measuring(solve.iteration);
    let next = select(next_pressure(limits, k, change_of_density, diagonal), k, is_first);
    let change = next - k;
    let direction = solve.beta * iterates[i].y + iterates[i].z;
    iterates[i] = vec4(next, direction, change, excess);
    let error = select(max(residual, diagonal * (limits.least - k)), abs(residual), k > limits.least);
    let work = select(select(0.0, k * residual, error > 0.0), complete + state.dt * rate, is_first);
    return vec4(error, diagonal * change * change, max(excess, 0.0), work);
}

@compute @workgroup_size(64)
fn implicit_residual(
    @builtin(global_invocation_id) gid: vec3<u32>,
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    if (solve.stopped != 0u) {
        return;
    }
    let i = linear_index(gid, groups, 64u);
    var own = vec4(0.0);
    if (i < active_count()) {
        own = update(i);
    }
    let sum = sum_of_group(local, own);
    let g = linear_group(group, groups);
    if (local == 0u && g < arrayLength(&residuals)) {
        residuals[g] = sum;
    }
}
