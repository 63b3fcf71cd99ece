use glam::Vec3;
use rayon::prelude::*;

use super::VertexNormalsBindings;

pub(super) fn vertex_normals(buffers: VertexNormalsBindings<'_>) {
    let VertexNormalsBindings { status, one_ring_starts, one_rings, vertex_positions: positions, normals } =
        buffers;
    let vertices = status.vertices as usize;
    let starts = &one_ring_starts[..=vertices];
    let normals = normals[..vertices].par_iter_mut();
    normals.zip(starts.par_windows(2)).with_min_len(2048).enumerate().for_each(
        |(vertex, (normal, range))| {
            let own = positions[vertex].truncate();
            let arm = |other: u32| positions[other as usize].truncate() - own;
            let ring = &one_rings[range[0] as usize..range[1] as usize];
            let sum = ring.iter().fold(Vec3::ZERO, |sum, pair| sum + arm(pair.x).cross(arm(pair.y)));
            // If the triangles have no area, the normal from the field remains.
            let scale = sum.abs().max_element();
            if scale > 1e-30 {
                let sum = sum / scale;
                *normal = (sum / sum.length()).extend(0.0);
            }
        },
    );
}
