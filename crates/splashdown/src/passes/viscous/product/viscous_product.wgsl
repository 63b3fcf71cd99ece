#import gpu/index
#import sph/params
#import sph/viscous_state
#import sph/grid
#import sph/rows
#import sph/images
#import sph/candidates
#import sph/neighbours
#import sph/viscous_pair
#import sph/group_sum

#bindings

override BODIES: u32 = 0u; // 1: the products contain the friction of bodies

// A term of the sum over the neighbours, for the preconditioned residuals of the particle and of its neighbour.
fn term_of(entry: u32, x: vec3<f32>, position: vec3<f32>, z: vec3<f32>, residual: vec4<f32>) -> vec3<f32> {
    let near = neighbour_of(entry, x, position);
    return viscous_weight(dot(near.d, near.d)) * viscous_pair(z, residual.w * residual.xyz, near.d, near.sign);
}

fn sum_of(i: u32, x: vec3<f32>, z: vec3<f32>) -> vec3<f32> {
    var sum = vec3(0.0);
    var visit = visit_of(i, x);
    while (visit.left != 0u) {
        let four = next_four(&visit, i, x);
        // All loads precede the terms, so that they overlap.
        let j = four & vec4(INDEX);
        let a = sorted_positions[j.x].xyz;
        let b = sorted_positions[j.y].xyz;
        let c = sorted_positions[j.z].xyz;
        let d = sorted_positions[j.w].xyz;
        let r_a = viscous_residuals[j.x];
        let r_b = viscous_residuals[j.y];
        let r_c = viscous_residuals[j.z];
        let r_d = viscous_residuals[j.w];
        sum += term_of(four.x, x, a, z, r_a);
        sum += term_of(four.y, x, b, z, r_b);
        sum += term_of(four.z, x, c, z, r_c);
        sum += term_of(four.w, x, d, z, r_d);
    }
    return sum;
}

// Writes the product of the matrix with the preconditioned residual, and returns the contributions to the sums.
fn product(i: u32) -> vec4<f32> {
    if (viscous_residuals[i].w == 0.0) {
        viscous_products[i] = vec4(0.0);
        return vec4(0.0);
    }
    let x = sorted_positions[i].xyz;
    let z = viscous_residuals[i].w * viscous_residuals[i].xyz;
    var w = z + state.dt * params.viscous_factor * sum_of(i, x, z);
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
