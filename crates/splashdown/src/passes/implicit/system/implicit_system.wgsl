#import gpu/index
#import sph/params
#import sph/grid
#import sph/rows
#import sph/kernel
#import sph/images
#import sph/wall_friction

#bindings

// The number of closed sides within the support of a point.
fn near_sides(x: vec3<f32>) -> u32 {
    let low = x - params.domain_min;
    let high = params.domain_max - x;
    var count = 0u;
    for (var axis = 0u; axis < 3u; axis++) {
        count += is_side_near(2u * axis, low[axis]) + is_side_near(2u * axis + 1u, high[axis]);
    }
    return count;
}

@compute @workgroup_size(64)
fn implicit_system(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    if (i >= active_count()) {
        return;
    }
    let x = sorted_positions[i].xyz;
    let v = sorted_velocities[i].xyz;
    let cell = cell_of(x);
    let support = params.support_radius;
    let scale = 1.0 / support;
    let scale5 = scale * scale * scale * scale * scale;
    let reach = support * support;
    let soft = 0.01 * reach;
    let volume = params.summed_mass / params.rest_density;
    let laminar = 10.0 * params.viscosity * volume;
    let artificial = params.artificial_viscosity * params.sound_speed * 0.5 * support * volume;

    var sum = 0.0;
    var gradient = vec3(0.0);
    var squares = 0.0;
    var a = vec3(0.0);
    for (var left = reflections_near(x); left != 0u; left &= left - 1u) {
        let by = reflection(firstTrailingBit(left));
        let own = reflected_point(by, x);
        let own_v = by.sign * v;
        gradient *= by.sign;
        a *= by.sign;
        for (var row = 0u; row < 9u; row++) {
            let range = row_range(cell, row);
            for (var j = range.x; j < range.y; j++) {
                let d = own - sorted_positions[j].xyz;
                let r2 = dot(d, d);
                if (r2 >= reach) {
                    continue;
                }
                let q = sqrt(r2) * scale;
                let g = kernel_g(q);
                let gd = g * d;
                sum += kernel_w(q);
                gradient += gd;
                squares += dot(gd, gd);
                let vx = dot(own_v - sorted_velocities[j].xyz, d);
                a += (vx / (r2 + soft) * (laminar + select(0.0, artificial, vx < 0.0))) * gd;
            }
        }
        gradient *= by.sign;
        a *= by.sign;
    }
    let factor = volume * scale5;
    let images = 1.0 + f32(near_sides(x)) / 3.0;
    densities[i] = vec2(params.summed_mass * scale * scale * scale * sum, 0.0);
    stiffness[i] = vec4(factor * gradient, images * factor * factor * squares);
    accelerations[i] = vec4(scale5 * a + body_acceleration(state.time) + wall_friction(x, v, state.dt), 0.0);
    iterates[i] = vec4(max(sorted_pressures[i], 0.0), 0.0, 0.0, 0.0);
}
