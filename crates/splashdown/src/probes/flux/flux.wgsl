#import gpu/index
#import sph/state
#import sph/grid
#import sph/probe

#bindings

@compute @workgroup_size(64)
fn flux(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    if (i >= min(cell_start[grid.cell_count], state.run_count)) {
        return;
    }
    let before = sorted_positions[i];
    if (before.w != 0.0) {
        return;
    }
    let after = positions[i].xyz;
    for (var k = 0u; k < arrayLength(&probes); k++) {
        let probe = probes[k];
        if (probe.kind != PROBE_FLOW) {
            continue;
        }
        let a = dot(before.xyz - probe.position, probe.normal);
        let b = dot(after - probe.position, probe.normal);
        if ((a < 0.0) == (b < 0.0)) {
            continue;
        }
        let at = before.xyz + a / (a - b) * (after - before.xyz) - probe.position;
        if (abs(dot(at, probe.along)) <= probe.half_along && abs(dot(at, probe.across)) <= probe.half_across) {
            // Adds 1, or -1 in two's complement.
            atomicAdd(&probe_counts[k], select(0xffffffffu, 1u, a < 0.0));
        }
    }
}
