#import gpu/index
#import sph/params
#import sph/body
#import sph/probe

#bindings

fn add(word: u32, value: f32) {
    probe_accounts[word] = bitcast<u32>(bitcast<f32>(probe_accounts[word]) + value);
}

@compute @workgroup_size(64)
fn accumulate(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let k = linear_index(gid, groups, 64u);
    if (k >= arrayLength(&probes) || state.run_count == 0u) {
        return;
    }
    let probe = probes[k];
    let account = k * ACCOUNT_WORDS;
    let sums = account + ACCOUNT_SUMS;
    let dt = state.dt;
    add(account + ACCOUNT_TIME, dt);
    if (probe.kind == PROBE_FORCE) {
        let body = bodies[probe.body];
        for (var a = 0u; a < 3u; a++) {
            add(sums + a, body.force[a] * dt);
            add(sums + 3u + a, body.torque[a] * dt);
        }
    } else if (probe.kind == PROBE_FLOW) {
        let volume = params.particle_spacing * params.particle_spacing * params.particle_spacing;
        add(sums, f32(bitcast<i32>(probe_counts[k])) * volume);
        probe_counts[k] = 0u;
    } else {
        add(sums, probe_values[k * PROBE_VALUES] * dt);
    }
    // The row is written by the step whose end is nearest to the due time.
    let elapsed = state.frame_duration - state.remaining + dt;
    let row = probe_accounts[account + ACCOUNT_ROWS];
    let next = bitcast<f32>(probe_accounts[account + ACCOUNT_NEXT]);
    if (elapsed + 0.5 * dt < next || row >= probe.most_rows) {
        return;
    }
    let at = (probe.first_row + row) * PROBE_ROW;
    let duration = bitcast<f32>(probe_accounts[account + ACCOUNT_TIME]);
    probe_rows[at] = elapsed;
    for (var v = 0u; v < PROBE_VALUES; v++) {
        probe_rows[at + 1u + v] = bitcast<f32>(probe_accounts[sums + v]) / duration;
        probe_accounts[sums + v] = 0u;
    }
    probe_accounts[account + ACCOUNT_TIME] = 0u;
    probe_accounts[account + ACCOUNT_ROWS] = row + 1u;
    // Each step longer than the interval writes a row.
    probe_accounts[account + ACCOUNT_NEXT] = bitcast<u32>(max(next + probe.interval, elapsed));
}
