#import gpu/index
#import sph/params
#import sph/grid
#import sph/flow

#bindings

fn holds(nozzle: Nozzle, x: vec3<f32>) -> bool {
    let o = x - nozzle.back;
    let along = dot(o, nozzle.direction);
    let a = dot(o, nozzle.across);
    let b = dot(o, nozzle.up);
    var inside = abs(a) <= nozzle.half_across && abs(b) <= nozzle.half_up;
    if (nozzle.disc == 1u) {
        inside = a * a + b * b <= nozzle.half_across * nozzle.half_across;
    }
    return inside && along >= -0.25 * params.particle_spacing && along <= nozzle.length;
}

@compute @workgroup_size(64)
fn inflow_constraint(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    if (i >= min(cell_start[grid.cell_count], state.run_count)) {
        return;
    }
    let x = sorted_positions[i].xyz;
    for (var k = 0u; k < arrayLength(&nozzles); k++) {
        let nozzle = nozzles[k];
        let is_on = state.time >= nozzle.start && state.time < nozzle.end
            && schedules[k * SCHEDULE_WORDS + SCHEDULE_EMITTED] + nozzle.points <= nozzle.most;
        if (is_on && holds(nozzle, x)) {
            let change = nozzle.speed * nozzle.direction - sorted_velocities[i].xyz;
            accelerations[i] = vec4(change / state.dt, 1.0);
            return;
        }
    }
}
