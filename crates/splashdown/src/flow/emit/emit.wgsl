#import gpu/index
#import sph/params
#import sph/grid
#import sph/rows
#import sph/flow

#bindings

const NEAREST: f32 = 0.7;

fn is_free(x: vec3<f32>) -> bool {
    let nearest = NEAREST * params.particle_spacing;
    let rows = rows_around(x);
    for (var row = 0u; row < 9u; row++) {
        let range = row_range(rows, row);
        for (var j = range.x; j < range.y; j++) {
            let p = positions[j];
            let d = p.xyz - x;
            if (p.w == 0.0 && dot(d, d) < nearest * nearest) {
                return false;
            }
        }
    }
    return true;
}

// As Nozzle::beside.
fn place_beside(id: u32) -> vec2<f32> {
    let steps = vec2(3242174889u, 2447445414u);
    return vec2<f32>((id * steps) >> vec2(8u)) * (2.0 / 16777216.0) - 1.0;
}

@compute @workgroup_size(64)
fn emit(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    var k = 0u;
    while (k < arrayLength(&nozzles) && i >= nozzles[k].first_point + nozzles[k].points) {
        k++;
    }
    if (k == arrayLength(&nozzles)) {
        return;
    }
    let nozzle = nozzles[k];
    let w = k * SCHEDULE_WORDS;
    if (atomicLoad(&schedules[w + SCHEDULE_LAYER]) == 0u) {
        return;
    }
    let q = points[i];
    let distance = bitcast<f32>(atomicLoad(&schedules[w + SCHEDULE_DISTANCE]));
    let place = i - nozzle.first_point;
    let id = atomicLoad(&schedules[w + SCHEDULE_ID]) + place;
    let beside = q.xy + nozzle.wobble * place_beside(id);
    let x = nozzle.back + (distance + q.z) * nozzle.direction + beside.x * nozzle.across + beside.y * nozzle.up;
    if (!is_free(x)) {
        atomicAdd(&schedules[w + SCHEDULE_BLOCKED], 1u);
        return;
    }
    let slot = atomicLoad(&schedules[w + SCHEDULE_SLOT]) + place;
    positions[slot] = vec4(x, 0.0);
    velocities[slot] = vec4(nozzle.speed * nozzle.direction, params.rest_density);
    ids[slot] = id;
    densities[slot] = vec2(params.rest_density, 0.0);
    atomicAdd(&schedules[w + SCHEDULE_EMITTED], 1u);
}
