#import gpu/index
#import sph/params
#import sph/solve
#import sph/grid
#import sph/rows
#import sph/kernel
#import sph/images
#import sph/group_sum

#bindings

override BODIES: u32 = 0u; // 1: bodies act on the fluid

fn pressure_of(j: u32) -> f32 {
    return max(iterates[j].x + solve.beta * iterates[j].y, 0.0);
}

// Writes the velocity of a particle by the present pressure, and returns the squares of its change, of the pressure and of
// the velocity.
fn update(i: u32) -> vec4<f32> {
    let other = accelerations[i];
    let v = sorted_velocities[i].xyz + state.dt * other.xyz;
    if (other.w == 1.0) {
        predicted[i] = vec4(v, -1.0);
        return vec4(0.0, 0.0, dot(v, v), 0.0);
    }
    let x = sorted_positions[i].xyz;
    let k = pressure_of(i);
    let cell = cell_of(x);
    let scale = 1.0 / params.support_radius;
    let reach = params.support_radius * params.support_radius;
    var sum = vec3(0.0);
    for (var left = reflections_near(x); left != 0u; left &= left - 1u) {
        let by = reflection(firstTrailingBit(left));
        let own = reflected_point(by, x);
        sum *= by.sign;
        for (var row = 0u; row < 9u; row++) {
            let range = row_range(cell, row);
            for (var j = range.x; j < range.y; j++) {
                let d = own - sorted_positions[j].xyz;
                let r2 = dot(d, d);
                if (r2 < reach) {
                    sum += ((k + pressure_of(j)) * kernel_g(sqrt(r2) * scale)) * d;
                }
            }
        }
        sum *= by.sign;
    }
    let factor = params.summed_mass / params.rest_density * scale * scale * scale * scale * scale;
    var q = factor * sum;
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
