#import gpu/index
#import sph/params
#import sph/viscous_state
#import sph/grid
#import sph/rows
#import sph/images
#import sph/viscous_pair
#import sph/group_sum

#bindings

override BODIES: u32 = 0u; // 1: the products contain the friction of bodies

// The preconditioned residual of a particle.
fn preconditioned(j: u32) -> vec3<f32> {
    return viscous_residuals[j].w * viscous_residuals[j].xyz;
}

// Writes the product of the matrix with the preconditioned residual, and returns the contributions to the sums.
fn product(i: u32) -> vec4<f32> {
    if (viscous_residuals[i].w == 0.0) {
        viscous_products[i] = vec4(0.0);
        return vec4(0.0);
    }
    let x = sorted_positions[i].xyz;
    let z = preconditioned(i);
    let cell = cell_of(x);
    let reach = params.support_radius * params.support_radius;
    var sum = vec3(0.0);
    for (var left = reflections_near(x); left != 0u; left &= left - 1u) {
        let by = reflection(firstTrailingBit(left));
        for (var row = 0u; row < 9u; row++) {
            let range = row_range(cell, row);
            for (var j = range.x; j < range.y; j++) {
                let d = x - reflected_point(by, sorted_positions[j].xyz);
                let r2 = dot(d, d);
                if (r2 < reach) {
                    sum += viscous_weight(r2) * viscous_pair(z, preconditioned(j), d, by.sign);
                }
            }
        }
    }
    var w = z + state.dt * params.viscous_factor * sum;
    if (BODIES == 1u) {
        w += viscous_products[i].xyz;
    }
    viscous_products[i] = vec4(w, 0.0);
    let r = viscous_residuals[i].xyz;
    return vec4(dot(r, z), dot(z, w), dot(r, r), dot(z, z));
}

@compute @workgroup_size(64)
fn viscous_product(
    @builtin(global_invocation_id) gid: vec3<u32>,
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    if (viscous.stopped != 0u) {
        return;
    }
    let i = linear_index(gid, groups, 64u);
    var own = vec4(0.0);
    if (i < active_count()) {
        own = product(i);
    }
    let sum = sum_of_group(local, own);
    let g = linear_group(group, groups);
    if (local == 0u && g < arrayLength(&residuals)) {
        residuals[g] = sum;
    }
}
