#import gpu/index
#import sph/params
#import sph/grid
#import sph/rows
#import sph/kernel
#import sph/walls

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
    let cell = cell_of(x);
    let support = params.support_radius;
    let scale = 1.0 / support;
    let scale5 = scale * scale * scale * scale * scale;
    let reach = support * support;
    let friction = params.viscosity * params.rest_density;

    var force = vec3(0.0);
    var normal = vec3(0.0);
    var laplacian = 0.0;
    for (var row = 0u; row < 9u; row++) {
        let range = row_range(cell, row);
        for (var j = range.x; j < range.y; j++) {
            let d = x - sorted_positions[j].xyz;
            let r2 = dot(d, d);
            if (r2 >= reach) {
                continue;
            }
            let q = sqrt(r2) * scale;
            let other = densities[j];
            let volume = params.particle_mass / other.x;
            force -= (volume * 0.5 * (pressure + other.y) * kernel_g(q)) * d;
            force += (friction * volume * viscosity_laplacian(q)) * (sorted_velocities[j].xyz - v);
            normal += (volume * poly6_g(q)) * d;
            laplacian += volume * poly6_laplacian(q);
        }
    }
    force *= scale5;
    normal *= scale5;
    laplacian *= scale5;
    let steepness = length(normal);
    if (steepness > 0.5 * scale) {
        force -= (params.surface_tension * laplacian / steepness) * normal;
    }
    var a = force / rho;

    a = wall_acceleration(wall_terms(x), v, body, a, pressure / rho, state.dt);
    accelerations[i] = vec4(a + body, 0.0);
}
