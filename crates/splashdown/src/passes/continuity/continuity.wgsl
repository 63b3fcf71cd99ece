#import gpu/index
#import sph/params
#import sph/grid
#import sph/rows
#import sph/kernel
#import sph/images

#bindings

@compute @workgroup_size(64)
fn continuity(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    if (i >= active_count()) {
        return;
    }
    let x = sorted_positions[i].xyz;
    let v = sorted_velocities[i].xyz;
    let rho = sorted_velocities[i].w;
    let cell = cell_of(x);
    let support = params.support_radius;
    let scale = 1.0 / support;
    let factor = params.summed_mass * scale * scale * scale * scale * scale;
    let reach = support * support;
    let soft = 0.01 * reach;
    let diffusion = params.density_diffusion * support * params.sound_speed;
    let hydrostatic = params.rest_density / (params.sound_speed * params.sound_speed) * body_acceleration(state.time);

    var rate = 0.0;
    for (var left = reflections_near(x); left != 0u; left &= left - 1u) {
        let by = reflection(firstTrailingBit(left));
        for (var row = 0u; row < 9u; row++) {
            let range = row_range(cell, row);
            for (var j = range.x; j < range.y; j++) {
                let p = sorted_positions[j].xyz;
                let d = x - reflected_point(by, p);
                let r2 = dot(d, d);
                if (r2 < reach) {
                    let other = sorted_velocities[j];
                    // The density of an image continues hydrostatically.
                    let psi = other.w - rho + dot(hydrostatic, x - p);
                    let flow = rho * dot(v - by.sign * other.xyz, d) - diffusion * psi * r2 / (r2 + soft);
                    rate += kernel_g(sqrt(r2) * scale) * factor / other.w * flow;
                }
            }
        }
    }
    let next = rho + state.dt * rate;
    densities[i] = vec2(next, pressure_at(next));
}
