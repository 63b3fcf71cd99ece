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
    if (k < 0.0) {
        iterates[i] = vec4(vec3(0.0), excess);
        return vec4(0.0, 0.0, max(excess, 0.0), 0.0);
    }
    var rate = rate_of(i, sorted_positions[i].xyz, u);
    var gradient = stiffness[i].xyz;
    var normal = gradient;
    if (BODIES == 1u) {
        let solid = solid_gradients[i];
        rate += dot(solid.xyz, u) - solid.w;
        gradient += solid.xyz;
        normal += 0.5 * solid.xyz;
    }
    let complete = excess + min(missing_density(normal), max(LARGEST_COMPLETED - excess, 0.0));
    let residual = complete + state.dt * rate - params.compressibility * k;
    let scale = 1.0 / params.support_radius;
    let squares = max(dot(gradient, gradient) + stiffness[i].w, 1e-6 * scale * scale);
    let diagonal = state.dt * state.dt * squares + params.compressibility;
    let next = max(k + solve.relaxation * residual / diagonal, 0.0);
    let change = next - k;
    let direction = solve.beta * iterates[i].y + iterates[i].z;
    iterates[i] = vec4(next, direction, change, excess);
    let error = select(max(residual, 0.0), abs(residual), k > 0.0);
    return vec4(error, diagonal * change * change, max(excess, 0.0), k * residual);
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
