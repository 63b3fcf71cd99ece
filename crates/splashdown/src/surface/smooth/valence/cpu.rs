use std::sync::atomic::Ordering;

use rayon::prelude::*;
use splashdown_gpu::as_atomic;

use super::ValenceBindings;

pub(super) fn valence(ValenceBindings { status, indices, valences }: ValenceBindings<'_>) {
    let triangles = &indices.as_chunks::<3>().0[..status.triangles as usize];
    let valences = as_atomic(valences);
    triangles.par_iter().with_min_len(4096).filter(|[a, b, _]| a != b).for_each(|triangle| {
        for &corner in triangle {
            valences[corner as usize].fetch_add(1, Ordering::Relaxed);
        }
    });
}
