#import gpu/index
#import sph/params
#import sph/grid
#import sph/flow

#bindings

// A point as distances from the centre of the back face along `across`, `up` and `direction`.
fn local_of(nozzle: Nozzle, x: vec3<f32>) -> vec3<f32> {
    let o = x - nozzle.back;
    return vec3(dot(o, nozzle.across), dot(o, nozzle.up), dot(o, nozzle.direction));
}

// Whether a place is within the cross-section, enlarged by `margin` on all sides.
fn is_within(nozzle: Nozzle, q: vec3<f32>, margin: f32) -> bool {
    let across = nozzle.half_across + margin;
    if (nozzle.disc == 1u) {
        return q.x * q.x + q.y * q.y <= across * across;
    }
    return abs(q.x) <= across && abs(q.y) <= nozzle.half_up + margin;
}

// As the constants of Nozzle.
const REACH: f32 = 1.5;
const MOST_CONTRACTION: f32 = 0.5;

// As Nozzle::velocity.
fn velocity_of(nozzle: Nozzle, q: vec3<f32>, beside: u32) -> vec3<f32> {
    let piston = nozzle.speed * nozzle.direction;
    if (q.z + nozzle.speed * state.dt <= nozzle.length) {
        return piston;
    }
    let rate = nozzle.stretching * dot(params.gravity, nozzle.direction);
    let most = MOST_CONTRACTION * nozzle.speed / vec2(nozzle.half_across, nozzle.half_up);
    let inwards = clamp(vec2(nozzle.share_across, nozzle.share_up) * rate, -most, most);
    let in_air = 1.0 - min(f32(beside) / nozzle.submerged_at, 1.0);
    let sideways = in_air * inwards * q.xy;
    return piston - sideways.x * nozzle.across - sideways.y * nozzle.up;
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
        let w = k * SCHEDULE_WORDS;
        let is_on = state.time >= nozzle.start && state.time < nozzle.end
            && atomicLoad(&schedules[w + SCHEDULE_EMITTED]) + nozzle.points <= nozzle.most;
        let q = local_of(nozzle, x);
        if (is_on && q.z >= -0.25 * params.particle_spacing && q.z <= nozzle.length && is_within(nozzle, q, 0.0)) {
            let velocity = velocity_of(nozzle, q, atomicLoad(&schedules[w + SCHEDULE_BESIDE]));
            accelerations[i] = vec4((velocity - sorted_velocities[i].xyz) / state.dt, 1.0);
            return;
        }
    }
    // Not in a pipe.
    for (var k = 0u; k < arrayLength(&nozzles); k++) {
        let nozzle = nozzles[k];
        let q = local_of(nozzle, x);
        let is_near = q.z >= 0.0 && q.z <= nozzle.length && is_within(nozzle, q, REACH * params.particle_spacing);
        let contracts = nozzle.share_across != 0.0 || nozzle.share_up != 0.0;
        if (contracts && is_near && !is_within(nozzle, q, 0.0)) {
            atomicAdd(&schedules[k * SCHEDULE_WORDS + SCHEDULE_COUNTED], 1u);
        }
    }
}
