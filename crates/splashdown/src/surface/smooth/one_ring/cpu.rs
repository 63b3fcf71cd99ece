use glam::UVec2;
use splashdown_gpu::{CpuWork, Slot};

use crate::surface::params::Status;

/// Serial: the pass is limited by memory, and several threads would need atomics.
pub(super) fn one_ring(_: CpuWork, slots: &mut [Slot<'_>]) {
    let [status, indices, starts, valences, one_rings] = slots else { unreachable!() };
    let triangles = status.get::<Status>().triangles as usize;
    let triangles = &indices.read::<u32>().as_chunks::<3>().0[..triangles];
    let (starts, valences, one_rings) =
        (starts.read::<u32>(), valences.write::<u32>(), one_rings.write::<UVec2>());
    for &[a, b, c] in triangles.iter().filter(|[a, b, _]| a != b) {
        for (vertex, next, last) in [(a, b, c), (b, c, a), (c, a, b)] {
            let left = &mut valences[vertex as usize];
            *left -= 1;
            one_rings[(starts[vertex as usize] + *left) as usize] = UVec2::new(next, last);
        }
    }
}
