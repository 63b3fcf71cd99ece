#import gpu/index
#import sph/params
#import sph/grid
#import sph/rows
#import sph/kernel
#import sph/images
#import sph/wall_friction

#bindings

@compute @workgroup_size(64)
fn mueller(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    if (i >= active_count()) {
        return;
    }
    let x = sorted_positions[i].xyz;
    let v = sorted_velocities[i].xyz;
    let rho = densities[i].x;
    let pressure = densities[i].y;
    let body = body_acceleration(state.time);
    let support = params.support_radius;
    let scale = 1.0 / support;
    let scale5 = scale * scale * scale * scale * scale;
    let reach = support * support;
    let friction = params.viscosity * params.rest_density;

    var force = vec3(0.0);
    var normal = vec3(0.0);
    var laplacian = 0.0;
    for (var left = reflections_near(x); left != 0u; left &= left - 1u) {
        let by = reflection(firstTrailingBit(left));
        let rows = rows_of_image(x, reflected_point(by, x));
        for (var row = 0u; row < 9u; row++) {
            let range = row_range(rows, row);
            for (var j = range.x; j < range.y; j++) {
                let p = sorted_positions[j].xyz;
                let image = reflected_point(by, p);
                let d = x - image;
                let r2 = dot(d, d);
                if (r2 >= reach) {
                    continue;
                }
                let q = sqrt(r2) * scale;
                let other = densities[j];
                let volume = params.summed_mass / other.x;
                let more = params.rest_density * dot(body, image - p);
                let other_pressure = extrapolated(other.y, more);
                force -= (volume * 0.5 * (pressure + other_pressure) * kernel_g(q)) * d;
                force += (friction * volume * viscosity_laplacian(q)) * (by.sign * sorted_velocities[j].xyz - v);
                normal += (volume * poly6_g(q)) * d;
                laplacian += volume * poly6_laplacian(q);
            }
        }
    }
    force *= scale5;
    normal *= scale5;
    laplacian *= scale5;
    let steepness = length(normal);
    if (steepness > 0.5 * scale) {
        force -= (params.surface_tension * laplacian / steepness) * normal;
    }
    accelerations[i] = vec4(force / rho + wall_friction(x, v, state.dt) + body, 0.0);
}
