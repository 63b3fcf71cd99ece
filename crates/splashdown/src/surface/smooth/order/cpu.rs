use glam::UVec2;
use rayon::prelude::*;
use splashdown_gpu::{CpuWork, Slot};

use crate::surface::params::Status;
use crate::surface::parts::by_starts;

/// Vertices of a task.
const CHUNK: usize = 4096;

pub(super) fn order(_: CpuWork, slots: &mut [Slot<'_>]) {
    let [status, starts, rings] = slots else { unreachable!() };
    let starts = &starts.read::<u32>()[..=status.get::<Status>().vertices as usize];
    let mut borders: Vec<u32> = starts.iter().step_by(CHUNK).copied().collect();
    borders.push(starts[starts.len() - 1]);
    let pieces = by_starts(rings.write::<UVec2>(), &borders);
    pieces.into_par_iter().enumerate().for_each(|(chunk, rings)| {
        let first = chunk * CHUNK;
        let starts = &starts[first.min(starts.len() - 1)..=(first + CHUNK).min(starts.len() - 1)];
        for range in starts.windows(2) {
            let ring = &mut rings[(range[0] - starts[0]) as usize..(range[1] - starts[0]) as usize];
            ring.sort_unstable_by_key(|pair| pair.x);
        }
    });
}
