use std::sync::atomic::Ordering;

use rayon::prelude::*;
use splashdown_gpu::{CpuWork, Slot};

use crate::surface::params::Status;

pub(super) fn valence(_: CpuWork, slots: &mut [Slot<'_>]) {
    let [status, indices, valences] = slots else { unreachable!() };
    let triangles = status.get::<Status>().triangles as usize;
    let triangles = &indices.read::<u32>().as_chunks::<3>().0[..triangles];
    let valences = valences.atomics();
    triangles.par_iter().with_min_len(4096).filter(|[a, b, _]| a != b).for_each(|triangle| {
        for &corner in triangle {
            valences[corner as usize].fetch_add(1, Ordering::Relaxed);
        }
    });
}
