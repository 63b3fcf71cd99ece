use glam::UVec2;
use splashdown_gpu::{CpuWork, Slot};

use crate::surface::params::Status;

/// Serial: it only moves memory, and a second core would need atomics for places that come in order here.
pub(super) fn ring(_: CpuWork, slots: &mut [Slot<'_>]) {
    let [status, indices, starts, valences, rings] = slots else { unreachable!() };
    let triangles = status.get::<Status>().triangles as usize;
    let triangles = &indices.read::<u32>().as_chunks::<3>().0[..triangles];
    let (starts, valences, rings) = (starts.read::<u32>(), valences.write::<u32>(), rings.write::<UVec2>());
    for &[a, b, c] in triangles.iter().filter(|[a, b, _]| a != b) {
        for (vertex, next, last) in [(a, b, c), (b, c, a), (c, a, b)] {
            let left = &mut valences[vertex as usize];
            *left -= 1;
            rings[(starts[vertex as usize] + *left) as usize] = UVec2::new(next, last);
        }
    }
}
