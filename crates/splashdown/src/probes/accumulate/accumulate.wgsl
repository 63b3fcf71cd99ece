#import gpu/index
#import sph/params
#import sph/body
#import sph/probe

#bindings

fn add(word: u32, value: f32) {
    probe_accounts[word] = bitcast<u32>(bitcast<f32>(probe_accounts[word]) + value);
}

// The state of the origin of a body's mesh; see pose_of in mod.rs.
fn write_pose(at: u32, body: Body) {
    let arm = turned(body.orientation, -body.center);
    let position = body.position + arm;
    let velocity = body.velocity + cross(body.angular_velocity, arm);
    for (var a = 0u; a < 4u; a++) {
        probe_rows[at + 3u + a] = body.orientation[a];
    }
    for (var a = 0u; a < 3u; a++) {
        probe_rows[at + a] = position[a];
        probe_rows[at + 7u + a] = velocity[a];
        probe_rows[at + 10u + a] = body.angular_velocity[a];
    }
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
    if (probe.kind == PROBE_FORCE || probe.kind == PROBE_BODY) {
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
    var means = at + 1u;
    if (probe.kind == PROBE_BODY) {
        write_pose(means, bodies[probe.body]);
        means += PROBE_POSE;
    }
    for (var v = 0u; v < PROBE_VALUES; v++) {
        probe_rows[means + v] = bitcast<f32>(probe_accounts[sums + v]) / duration;
        probe_accounts[sums + v] = 0u;
    }
    probe_accounts[account + ACCOUNT_TIME] = 0u;
    probe_accounts[account + ACCOUNT_ROWS] = row + 1u;
    // Each step longer than the interval writes a row.
    probe_accounts[account + ACCOUNT_NEXT] = bitcast<u32>(max(next + probe.interval, elapsed));
}
