use glam::UVec2;

use super::OneRingBindings;

/// Serial: the pass is limited by memory, and several threads would need atomics.
pub(super) fn one_ring(buffers: OneRingBindings<'_>) {
    let OneRingBindings { status, indices, one_ring_starts: starts, valences, one_rings } = buffers;
    let triangles = &indices.as_chunks::<3>().0[..status.triangles as usize];
    for &[a, b, c] in triangles.iter().filter(|[a, b, _]| a != b) {
        for (vertex, next, last) in [(a, b, c), (b, c, a), (c, a, b)] {
            let left = &mut valences[vertex as usize];
            *left -= 1;
            one_rings[(starts[vertex as usize] + *left) as usize] = UVec2::new(next, last);
        }
    }
}
