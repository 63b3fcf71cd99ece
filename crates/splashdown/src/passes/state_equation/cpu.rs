use glam::{Vec2, Vec4};
use rayon::prelude::*;
use splashdown_gpu::{CpuWork, Slot};

use crate::state::{Params, StepState};

pub(super) fn state_equation(_: CpuWork, slots: &mut [Slot<'_>]) {
    let [params, state, velocities, densities] = slots else { unreachable!() };
    let (params, n) = (params.get::<Params>(), state.get::<StepState>().run_count as usize);
    let velocities = velocities.read::<Vec4>()[..n].par_iter().with_min_len(4096);
    densities.write::<Vec2>()[..n].par_iter_mut().zip(velocities).for_each(|(density, v)| {
        *density = Vec2::new(v.w, params.pressure_at(v.w));
    });
}
