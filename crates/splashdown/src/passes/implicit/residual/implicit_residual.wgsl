#import gpu/index
#import sph/params
#import sph/solve
#import sph/grid
#import sph/rows
#import sph/kernel
#import sph/images
#import sph/group_sum

#bindings

override BODIES: u32 = 0u; // 1: bodies contribute to the density

// See the module.
const SMALLEST_SURFACE_GRADIENT: f32 = 0.3;
const LARGEST_COMPLETED: f32 = 0.02;

// The sum over the neighbours in the rate of the density.
fn rate_of(x: vec3<f32>, u: vec3<f32>) -> f32 {
    let cell = cell_of(x);
    let scale = 1.0 / params.support_radius;
    let reach = params.support_radius * params.support_radius;
    var sum = 0.0;
    for (var left = reflections_near(x); left != 0u; left &= left - 1u) {
        let by = reflection(firstTrailingBit(left));
        let own = reflected_point(by, x);
        let own_u = by.sign * u;
        for (var row = 0u; row < 9u; row++) {
            let range = row_range(cell, row);
            for (var j = range.x; j < range.y; j++) {
                let d = own - sorted_positions[j].xyz;
                let r2 = dot(d, d);
                if (r2 < reach) {
                    sum += kernel_g(sqrt(r2) * scale) * dot(d, own_u - predicted[j].xyz);
                }
            }
        }
    }
    return params.summed_mass / params.rest_density * scale * scale * scale * scale * scale * sum;
}

// What a particle at the free surface lacks of the rest density, for the gradient of the sum of V W over fluid and bodies.
fn missing_density(gradient: vec3<f32>) -> f32 {
    let beyond = max(params.support_radius * length(gradient) - SMALLEST_SURFACE_GRADIENT, 0.0);
    return params.surface_completion * beyond * sqrt(beyond);
}

// Updates the iterate of a particle, and returns its contributions to the sums.
fn update(i: u32) -> vec4<f32> {
    let excess = densities[i].x / params.rest_density - 1.0;
    let u = predicted[i].xyz;
    let k = predicted[i].w;
    if (k < 0.0) {
        iterates[i] = vec4(0.0);
        return vec4(0.0, 0.0, max(excess, 0.0), 0.0);
    }
    var rate = rate_of(sorted_positions[i].xyz, u);
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
    iterates[i] = vec4(next, direction, change, residual);
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
