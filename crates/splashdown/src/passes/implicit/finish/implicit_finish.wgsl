#import gpu/index
#import sph/params
#import sph/solve
#import sph/grid
#import sph/rows

#bindings

@compute @workgroup_size(256)
fn implicit_finish(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 256u);
    if (i >= state.run_count) {
        return;
    }
    if (i >= active_count()) {
        pressures[i] = 0.0;
        return;
    }
    let before = sorted_velocities[i].xyz;
    let other = accelerations[i];
    let free = before + state.dt * other.xyz;
    let u = free + solve.scale * (predicted[i].xyz - free);
    let k = solve.scale * max(predicted[i].w, 0.0);
    let rho = densities[i].x;
    predicted[i] = vec4((u - free) / state.dt, k);
    accelerations[i] = vec4((u - before) / state.dt, other.w);
    densities[i] = vec2(rho, params.pressure_factor * k * rho * rho / params.rest_density);
    pressures[i] = solve.warm_start * mix(max(sorted_pressures[i], 0.0), k, solve.renewal);
}
