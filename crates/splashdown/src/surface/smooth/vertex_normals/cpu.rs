use glam::{UVec2, Vec3, Vec4};
use rayon::prelude::*;
use splashdown_gpu::{CpuWork, Slot};

use crate::surface::params::Status;

pub(super) fn vertex_normals(_: CpuWork, slots: &mut [Slot<'_>]) {
    let [status, starts, one_rings, positions, normals] = slots else { unreachable!() };
    let vertices = status.get::<Status>().vertices as usize;
    let (starts, one_rings) = (&starts.read::<u32>()[..=vertices], one_rings.read::<UVec2>());
    let positions = positions.read::<Vec4>();
    let normals = normals.write::<Vec4>()[..vertices].par_iter_mut();
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
