#import gpu/index
#import sph/params
#import sph/grid
#import sph/rows
#import sph/kernel
#import sph/images
#import sph/candidates
#import sph/wall_friction
#import sph/correction
#import sph/tension

#bindings

@compute @workgroup_size(64)
fn corrected_acceleration(
    @builtin(global_invocation_id) gid: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
) {
    let i = linear_index(gid, groups, 64u);
    if (i >= active_count()) {
        return;
    }
    let has_tension = params.surface_tension > 0.0;
    if (has_tension) {
        own_normal = normals[i].xyz;
    }
    let x = sorted_positions[i].xyz;
    let v = sorted_velocities[i].xyz;
    let rho = densities[i].x;
    let specific = densities[i].y / (rho * rho);
    let first = corrections[2u * i];
    let own = Symmetric(specific * first.xyz, specific * corrections[2u * i + 1u].xyz);
    let body = body_acceleration(state.time);

    let support = params.support_radius;
    let scale = 1.0 / support;
    let scale5 = scale * scale * scale * scale * scale;
    let soft = 0.01 * support * support;
    let mass = params.summed_mass;
    let volume = mass / params.rest_density;
    let laminar = 10.0 * params.viscosity * volume;
    let artificial = 0.5 * support * volume;
    let artificial_speed = params.artificial_viscosity * params.sound_speed;

    var a = vec3(0.0);
    var concentration = vec3(0.0);
    for (var left = reflections_near(x); left != 0u; left &= left - 1u) {
        let by = reflection(firstTrailingBit(left));
        let own_x = reflected_point(by, x);
        let own_v = by.sign * v;
        // The hydrostatic difference between an image and its particle is linear in the particle's position.
        let slope = (by.sign - 1.0) * body / params.rest_density;
        let offset = dot(by.shift, body) / params.rest_density;
        let own_stress = Symmetric(own.diagonal, by.sign.xxy * by.sign.yzz * own.others);
        a *= by.sign;
        concentration *= by.sign;
        let rows = rows_of_image(x, own_x);
        for (var row = 0u; row < 9u; row++) {
            let range = row_range(rows, row);
            for (var first = range.x; first < range.y; first += CANDIDATES) {
                for (var bits = neighbour_bits(own_x, first, range.y); bits != 0u; bits &= bits - 1u) {
                    let j = first + firstTrailingBit(bits);
                    let p = sorted_positions[j].xyz;
                    let d = own_x - p;
                    let r2 = dot(d, d);
                    let r = sqrt(r2);
                    let q = r * scale;
                    let g = kernel_g(q) * scale5;
                    let other = densities[j];
                    let vx = dot(own_v - sorted_velocities[j].xyz, d);
                    let approach = min(-3.0 * vx * r / (r2 + soft), params.sound_speed);
                    let speed = select(0.0, approach + artificial_speed, vx < 0.0);
                    let viscous = vx * (laminar + artificial * speed) / (r2 + soft);
                    let more = offset + dot(slope, p);
                    let pressure = extrapolated(other.y / (other.x * other.x), more);
                    let stress = Symmetric(
                        own_stress.diagonal + pressure * corrections[2u * j].xyz,
                        own_stress.others + pressure * corrections[2u * j + 1u].xyz,
                    );
                    a += g * (viscous * d - mass * applied(stress, d));
                    let near = kernel_w(q) * params.inverse_kernel_at_spacing;
                    concentration += g * (1.0 + 0.2 * near * near * near * near) * d;
                    if (has_tension) {
                        a += by.sign * tension_between(i, j, by.sign, by.sign * d, q, rho, other.x);
                    }
                }
            }
        }
        a *= by.sign;
        concentration *= by.sign;
    }
    a += body + wall_friction(x, v, state.dt);
    accelerations[i] = vec4(a, 0.0);
    shifts[i] = vec4(-first.w * volume * concentration, rho);
}
