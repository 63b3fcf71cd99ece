#import gpu/index
#import sph/params
#import sph/grid
#import sph/flow

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<uniform> grid: Grid;
@group(0) @binding(2) var<storage, read> state: StepState;
@group(0) @binding(3) var<storage, read> cell_start: array<u32>;
@group(0) @binding(4) var<storage, read> nozzles: array<Nozzle>;
@group(0) @binding(5) var<storage, read> schedules: array<u32>;
@group(0) @binding(6) var<storage, read> sorted_positions: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read> sorted_velocities: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read_write> accelerations: array<vec4<f32>>;

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
            accelerations[i] = vec4(change / state.dt, 0.0);
            return;
        }
    }
}
