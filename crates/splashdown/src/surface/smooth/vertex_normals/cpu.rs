use glam::Vec3;
use rayon::prelude::*;

use super::VertexNormalsBindings;

pub(super) fn vertex_normals(buffers: VertexNormalsBindings<'_>) {
    let VertexNormalsBindings {
        lattice,
        status,
        one_ring_starts,
        one_rings,
        vertex_positions: positions,
        normals,
    } = buffers;
    let walls = lattice.walls();
    let vertices = status.vertices as usize;
    let starts = &one_ring_starts[..=vertices];
    let normals = normals[..vertices].par_iter_mut();
    normals.zip(starts.par_windows(2)).with_min_len(2048).enumerate().for_each(
        |(vertex, (normal, range))| {
            let own = positions[vertex].truncate();
            if let Some(of_wall) = walls.normal_at(own) {
                *normal = of_wall.extend(0.0);
                return;
            }
            let ring = &one_rings[range[0] as usize..range[1] as usize];
            let sum = ring.iter().fold(Vec3::ZERO, |sum, pair| {
                let [first, second] = [pair.x, pair.y].map(|other| positions[other as usize].truncate());
                let is_free = !walls.touch(first) && !walls.touch(second);
                sum + if is_free { (first - own).cross(second - own) } else { Vec3::ZERO }
            });
            // If the triangles have no area, the normal from the field remains.
            let scale = sum.abs().max_element();
            if scale > 1e-30 {
                let sum = sum / scale;
                *normal = (sum / sum.length()).extend(0.0);
            }
        },
    );
}
