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

override BODIES: u32 = 0u; // 1: bodies act on the fluid

// The pressure for a result and the previous direction.
fn pressure_of(iterate: vec2<f32>) -> f32 {
    let least = select(0.0, -tension_limit(), iterate.x < 0.0);
    return max(iterate.x + solve.beta * iterate.y, least);
}

// A term of the sum over the neighbours; k is the sum of both pressures.
fn term_of(entry: u32, x: vec3<f32>, position: vec3<f32>, k: f32) -> vec3<f32> {
    let d = neighbour_of(entry, x, position).d;
    return (k * kernel_g(length(d) / params.support_radius)) * d;
}

fn pressure_sum(i: u32, x: vec3<f32>, k: f32) -> vec3<f32> {
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
        let k_a = iterates[j.x].xy;
        let k_b = iterates[j.y].xy;
        let k_c = iterates[j.z].xy;
        let k_d = iterates[j.w].xy;
        let both = vec4(k) + vec4(pressure_of(k_a), pressure_of(k_b), pressure_of(k_c), pressure_of(k_d));
        sum += term_of(four.x, x, a, both.x);
        sum += term_of(four.y, x, b, both.y);
        sum += term_of(four.z, x, c, both.z);
        sum += term_of(four.w, x, d, both.w);
    }
    return sum;
}

// Writes the velocity of a particle by the present pressure, and returns the squares of its change, of the pressure and of
// the velocity.
fn update(i: u32) -> vec4<f32> {
    let v = free_velocities[i].xyz;
    if (free_velocities[i].w == 1.0) {
        predicted[i] = vec4(v, NO_PRESSURE);
        return vec4(0.0, 0.0, dot(v, v), 0.0);
    }
    let x = sorted_positions[i].xyz;
    let k = pressure_of(iterates[i].xy);
    let scale = 1.0 / params.support_radius;
    let factor = params.summed_mass / params.rest_density * scale * scale * scale * scale * scale;
    var q = factor * pressure_sum(i, x, k);
    if (BODIES == 1u) {
        q += k * solid_gradients[i].xyz;
    }
    let u = v - state.dt * q;
    predicted[i] = vec4(u, k);
    return vec4(state.dt * state.dt * dot(q, q), k * k, dot(u, u), 0.0);
}

@compute @workgroup_size(64)
fn implicit_predict(
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
    if (local == 0u && g < arrayLength(&impulses)) {
        impulses[g] = sum;
    }
}
