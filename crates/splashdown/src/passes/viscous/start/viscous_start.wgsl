#import gpu/index
#import sph/params
#import sph/viscous_state
#import sph/grid
#import sph/rows
#import sph/kernel
#import sph/images
#import sph/viscous_pair
#import sph/group_sum

#bindings

override BODIES: u32 = 0u; // 1: bodies act on the fluid

// Writes the first residual of a particle, and returns the squared change of its velocity by the other forces.
fn start(i: u32) -> f32 {
    let other = accelerations[i];
    let own = iterates[i].x;
    if (other.w == 1.0) {
        viscous_residuals[i] = vec4(0.0);
        iterates[i] = vec4(own, 0.0, 0.0, 0.0);
        return 0.0;
    }
    let x = sorted_positions[i].xyz;
    let v = sorted_velocities[i].xyz;
    let scale = 1.0 / params.support_radius;
    let reach = params.support_radius * params.support_radius;
    var viscous_sum = vec3(0.0);
    var trace = 0.0;
    var pressure_sum = vec3(0.0);
    for (var left = reflections_near(x); left != 0u; left &= left - 1u) {
        let by = reflection(firstTrailingBit(left));
        let rows = rows_of_image(x, reflected_point(by, x));
        for (var row = 0u; row < 9u; row++) {
            let range = row_range(rows, row);
            for (var j = range.x; j < range.y; j++) {
                let d = x - reflected_point(by, sorted_positions[j].xyz);
                let r2 = dot(d, d);
                if (r2 < reach) {
                    let weight = viscous_weight(r2);
                    viscous_sum += weight * viscous_pair(v, sorted_velocities[j].xyz, d, by.sign);
                    trace += weight * r2;
                    pressure_sum += ((own + iterates[j].x) * kernel_g(sqrt(r2) * scale)) * d;
                }
            }
        }
    }
    let volume = params.summed_mass / params.rest_density;
    var pressure = (-volume * scale * scale * scale * scale * scale) * pressure_sum;
    if (BODIES == 1u) {
        pressure -= own * solid_gradients[i].xyz;
    }
    let dt = state.dt;
    let residual = dt * (other.xyz + pressure - params.viscous_factor * viscous_sum);
    viscous_residuals[i] = vec4(residual, 1.0 / (1.0 + dt * params.viscous_factor * trace / 3.0));
    iterates[i] = vec4(own, pressure);
    return dt * dt * dot(other.xyz, other.xyz);
}

@compute @workgroup_size(64)
fn viscous_start(
    @builtin(global_invocation_id) gid: vec3<u32>,
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    // The step may be suspended.
    if (viscous.stopped != 0u || state.run_count == 0u) {
        return;
    }
    let i = linear_index(gid, groups, 64u);
    var own = vec4(0.0);
    if (i < active_count()) {
        own.x = start(i);
    }
    let sum = sum_of_group(local, own);
    let g = linear_group(group, groups);
    if (local == 0u && g < arrayLength(&impulses)) {
        impulses[g] = sum;
    }
}
