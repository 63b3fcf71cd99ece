use std::sync::atomic::{AtomicU32, Ordering};

use glam::Vec4Swizzles;
use rayon::prelude::*;

use super::FluxBindings;
use crate::probes::ProbePoint;

pub(super) fn flux(buffers: FluxBindings<'_>) {
    let FluxBindings { grid, state, cell_start, probes, sorted_positions, positions, probe_counts: counts } =
        buffers;
    let active = cell_start[grid.cell_count as usize];
    let n = active.min(state.run_count) as usize;
    let flows: Vec<_> =
        probes.iter().enumerate().filter(|(_, probe)| probe.kind == ProbePoint::FLOW).collect();
    let sums: Vec<AtomicU32> = probes.iter().map(|_| AtomicU32::new(0)).collect();
    let paths = sorted_positions[..n].par_iter().zip(&positions[..n]);
    paths.with_min_len(4096).filter(|(before, _)| before.w == 0.0).for_each(|(before, after)| {
        let (before, after) = (before.xyz(), after.xyz());
        for (k, probe) in &flows {
            let [a, b] = [before, after].map(|x| (x - probe.position).dot(probe.normal));
            if (a < 0.0) == (b < 0.0) {
                continue;
            }
            let at = before + a / (a - b) * (after - before) - probe.position;
            if at.dot(probe.along).abs() <= probe.half_along
                && at.dot(probe.across).abs() <= probe.half_across
            {
                // Adds 1, or -1 in two's complement.
                sums[*k].fetch_add(if a < 0.0 { 1 } else { u32::MAX }, Ordering::Relaxed);
            }
        }
    });
    for (count, sum) in counts.iter_mut().zip(sums) {
        *count = count.wrapping_add(sum.into_inner());
    }
}
