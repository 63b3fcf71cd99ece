#import gpu/index
#import sph/grid
#import sph/state
#import sph/step_counters
#import sph/flow

#bindings

fn takes(drain: SinkShape, x: vec3<f32>) -> bool {
    if (drain.kind == 1u) {
        return dot(x - drain.low, drain.high) < 0.0;
    }
    let inside = all(x >= drain.low) && all(x <= drain.high);
    if (drain.kind == 0u || !inside) {
        return inside;
    }
    let at = (x - drain.low) / drain.cell_size;
    let c = min(vec3<u32>(at), drain.nodes - 2u);
    let f = at - vec3<f32>(c);
    let row = drain.nodes.x;
    let plane = row * drain.nodes.y;
    let first = drain.first_node + c.z * plane + c.y * row + c.x;
    var sides: array<f32, 2>;
    for (var z = 0u; z < 2u; z++) {
        let k = first + z * plane;
        let low = mix(drain_maps[k], drain_maps[k + 1u], f.x);
        let high = mix(drain_maps[k + row], drain_maps[k + row + 1u], f.x);
        sides[z] = mix(low, high, f.y);
    }
    return mix(sides[0], sides[1], f.z) < 0.0;
}

@compute @workgroup_size(64)
fn sink(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    if (i >= min(cell_start[grid.cell_count], state.run_count)) {
        return;
    }
    let p = sorted_positions[i];
    if (p.w != 0.0) {
        return;
    }
    for (var k = 0u; k < arrayLength(&drains); k++) {
        if (takes(drains[k], p.xyz)) {
            sorted_positions[i].w = DEAD_DRAINED;
            atomicAdd(&counters[COUNTER_DRAINED], 1u);
            return;
        }
    }
}
