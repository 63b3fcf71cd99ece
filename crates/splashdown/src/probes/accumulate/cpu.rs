use super::AccumulateBindings;
use crate::probes::{Account, POSE, ProbePoint, ROW, VALUES, pose_of};

pub(super) fn accumulate(buffers: AccumulateBindings<'_>) {
    let AccumulateBindings {
        params,
        state,
        probes,
        bodies,
        probe_values: values,
        probe_counts: counts,
        probe_accounts: accounts,
        probe_rows: rows,
    } = buffers;
    if state.run_count == 0 {
        return;
    }
    let values = values.chunks_exact(VALUES);
    let accounts = accounts.chunks_exact_mut(Account::WORDS);
    let probes = probes.iter().zip(values).zip(counts).zip(accounts);
    for (((probe, values), count), account) in probes {
        let dt = state.dt;
        let add = |word: &mut u32, value: f32| *word = (f32::from_bits(*word) + value).to_bits();
        add(&mut account[Account::TIME], dt);
        let sums = &mut account[Account::SUMS..];
        if probe.has_force() {
            let body = &bodies[probe.body as usize];
            for a in 0..3 {
                add(&mut sums[a], body.force[a] * dt);
                add(&mut sums[3 + a], body.torque[a] * dt);
            }
        } else if probe.kind == ProbePoint::FLOW {
            add(&mut sums[0], *count as i32 as f32 * params.particle_spacing.powi(3));
            *count = 0;
        } else {
            add(&mut sums[0], values[0] * dt);
        }
        // The row is written by the step whose end is nearest to the due time.
        let elapsed = state.frame_duration - state.remaining + dt;
        let row = account[Account::ROWS];
        let next = f32::from_bits(account[Account::NEXT]);
        if elapsed + 0.5 * dt < next || row >= probe.most_rows {
            continue;
        }
        let at = (probe.first_row + row) as usize * ROW;
        let duration = f32::from_bits(account[Account::TIME]);
        rows[at] = elapsed;
        if probe.kind == ProbePoint::BODY {
            rows[at + 1..][..POSE].copy_from_slice(&pose_of(&bodies[probe.body as usize]));
        }
        let means = at + 1 + probe.pose_length();
        for v in 0..VALUES {
            let sum = &mut account[Account::SUMS + v];
            rows[means + v] = f32::from_bits(*sum) / duration;
            *sum = 0;
        }
        account[Account::TIME] = 0;
        account[Account::ROWS] = row + 1;
        // Each step longer than the interval writes a row.
        account[Account::NEXT] = (next + probe.interval).max(elapsed).to_bits();
    }
}
