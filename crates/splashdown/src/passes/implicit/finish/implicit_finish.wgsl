#import gpu/index
#import sph/params
#import sph/solve
#import sph/grid
#import sph/rows
#import sph/step_counters

#bindings

// The largest pressure of the workgroup, as bits of a float.
var<workgroup> highest: atomic<u32>;

// Returns the pressure over the rest density that limits the next step; see the module.
fn finish(i: u32) -> f32 {
    let before = sorted_velocities[i].xyz;
    let other = accelerations[i];
    let solved = before + state.dt / solve.advanced_part * other.xyz;
    var free = before + state.dt * other.xyz;
    var u = free + solve.scale * (predicted[i].xyz - solved);
    var k = solve.scale / solve.advanced_part * predicted[i].w;
    if (predicted[i].w == NO_PRESSURE) {
        free = solved;
        u = solved;
        k = 0.0;
    }
    let rho = densities[i].x;
    predicted[i] = vec4((u - free) / state.dt, k);
    accelerations[i] = vec4((u - before) / state.dt, other.w);
    densities[i] = vec2(rho, params.pressure_factor * k * rho * rho / params.rest_density);
    let old = sorted_pressures[i];
    pressures[i] = solve.warm_start * mix(old, k * solve.advanced_part, solve.renewal);
    return max(mix(old, k, max(solve.renewal, 1.0 - solve.renewal)), 0.0);
}

@compute @workgroup_size(256)
fn implicit_finish(
    @builtin(global_invocation_id) gid: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    if (local == 0u) {
        atomicStore(&highest, 0u);
    }
    workgroupBarrier();
    let i = linear_index(gid, groups, 256u);
    if (i < min(active_count(), state.run_count)) {
        atomicMax(&highest, bitcast<u32>(finish(i)));
    } else if (i < state.run_count) {
        pressures[i] = 0.0;
    }
    workgroupBarrier();
    if (local == 0u) {
        atomicMax(&counters[COUNTER_MAX_PRESSURE], atomicLoad(&highest));
    }
}
