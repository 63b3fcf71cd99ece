#import gpu/index
#import sph/params
#import sph/grid
#import sph/rows
#import sph/images
#import sph/candidates
#import sph/neighbours
#import sph/kernel
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

// The sums over the neighbours.
struct Sums {
    density: f32,
    squares: f32,
    gradient: vec3<f32>,
    viscous: vec3<f32>,
}

fn add(
    sums: ptr<function, Sums>,
    entry: u32,
    x: vec3<f32>,
    position: vec3<f32>,
    v: vec3<f32>,
    other: vec3<f32>,
    viscosity: vec2<f32>, // of pairs that separate, and of those that approach
) {
    let near = neighbour_of(entry, x, position);
    let d = near.d;
    let r2 = dot(d, d);
    let q = sqrt(r2) / params.support_radius;
    let gd = kernel_g(q) * d;
    (*sums).density += select(kernel_w(q), 0.0, entry >> INDEX_BITS == NO_NEIGHBOUR);
    (*sums).gradient += gd;
    (*sums).squares += dot(gd, gd);
    let vx = dot(v - near.sign * other, d);
    let soft = 0.01 * params.support_radius * params.support_radius;
    (*sums).viscous += (vx / (r2 + soft) * select(viscosity.x, viscosity.y, vx < 0.0)) * gd;
}

fn sums_of(i: u32, x: vec3<f32>, v: vec3<f32>) -> Sums {
    let volume = params.summed_mass / params.rest_density;
    let laminar = 10.0 * params.viscosity * volume;
    let artificial = params.artificial_viscosity * params.sound_speed * 0.5 * params.support_radius * volume;
    let viscosity = vec2(laminar, laminar + artificial);
    var sums = Sums(0.0, 0.0, vec3(0.0), vec3(0.0));
    var visit = visit_of(i, x);
    while (visit.left != 0u) {
        let four = next_four(&visit, i, x);
        // All loads precede the terms, so that they overlap.
        let j = four & vec4(INDEX);
        let a = sorted_positions[j.x].xyz;
        let b = sorted_positions[j.y].xyz;
        let c = sorted_positions[j.z].xyz;
        let d = sorted_positions[j.w].xyz;
        let v_a = sorted_velocities[j.x].xyz;
        let v_b = sorted_velocities[j.y].xyz;
        let v_c = sorted_velocities[j.z].xyz;
        let v_d = sorted_velocities[j.w].xyz;
        add(&sums, four.x, x, a, v, v_a, viscosity);
        add(&sums, four.y, x, b, v, v_b, viscosity);
        add(&sums, four.z, x, c, v, v_c, viscosity);
        add(&sums, four.w, x, d, v, v_d, viscosity);
    }
    return sums;
}

@compute @workgroup_size(64)
fn implicit_system(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    if (i >= active_count()) {
        return;
    }
    let x = sorted_positions[i].xyz;
    let v = sorted_velocities[i].xyz;
    let scale = 1.0 / params.support_radius;
    let scale5 = scale * scale * scale * scale * scale;
    let sums = sums_of(i, x, v);
    let factor = params.summed_mass / params.rest_density * scale5;
    let images = 1.0 + f32(near_sides(x)) / 3.0;
    densities[i] = vec2(params.summed_mass * scale * scale * scale * sums.density, 0.0);
    stiffness[i] = vec4(factor * sums.gradient, images * factor * factor * sums.squares);
    accelerations[i] = vec4(scale5 * sums.viscous + body_acceleration(state.time) + wall_friction(x, v, state.dt), 0.0);
}
