use glam::{UVec2, Vec3, Vec4};
use rayon::prelude::*;
use splashdown_gpu::{CpuWork, Slot};

use crate::surface::params::Status;

pub(super) fn relax(_: CpuWork, slots: &mut [Slot<'_>]) {
    let [status, starts, one_rings, before, after] = slots else { unreachable!() };
    let vertices = status.get::<Status>().vertices as usize;
    let (starts, one_rings) = (&starts.read::<u32>()[..=vertices], one_rings.read::<UVec2>());
    let before = before.read::<Vec4>();
    let after = &mut after.write::<Vec4>()[..vertices];
    after.par_iter_mut().zip(starts.par_windows(2)).with_min_len(2048).enumerate().for_each(
        |(vertex, (after, range))| {
            let own = before[vertex];
            let ring = &one_rings[range[0] as usize..range[1] as usize];
            // Relative to the vertex, which avoids cancellation far from the origin.
            let sum = ring.iter().fold(Vec4::ZERO, |sum, pair| sum + (before[pair.x as usize] - own));
            let step: Vec3 = sum.truncate() * (own.w / ring.len().max(1) as f32);
            *after = (own.truncate() + step).extend(own.w);
        },
    );
}
