use glam::{Vec2, Vec4, Vec4Swizzles};
use rayon::prelude::*;
use splashdown_gpu::{CpuWork, Slot};

use crate::passes::{DEAD_NON_FINITE, Params, StepState, Tally};

const CHUNK: usize = 4096;

/// What a chunk of particles adds to the tally.
#[derive(Default)]
struct Found {
    non_finite: u32,
    corrections: u32,
    limited: u32,
    highest: [f32; 3],
}

pub(super) fn integrate(_: CpuWork, slots: &mut [Slot<'_>]) {
    let [
        params,
        state,
        sorted_positions,
        sorted_velocities,
        densities,
        accelerations,
        positions,
        velocities,
        tally,
    ] = slots
    else {
        unreachable!()
    };
    let (params, state) = (&params.get::<Params>(), state.get::<StepState>());
    let n = state.run_count as usize;
    let found: Vec<Found> = sorted_positions.read::<Vec4>()[..n]
        .par_chunks(CHUNK)
        .zip(sorted_velocities.read::<Vec4>()[..n].par_chunks(CHUNK))
        .zip(densities.read::<Vec2>()[..n].par_chunks(CHUNK))
        .zip(accelerations.read::<Vec4>()[..n].par_chunks(CHUNK))
        .zip(positions.write::<Vec4>()[..n].par_chunks_mut(CHUNK))
        .zip(velocities.write::<Vec4>()[..n].par_chunks_mut(CHUNK))
        .map(|(((((p, v), density), a), new_p), new_v)| {
            let mut found = Found::default();
            for k in 0..p.len() {
                (new_p[k], new_v[k]) = advance(params, state.dt, p[k], v[k], density[k].x, a[k], &mut found);
            }
            found
        })
        .collect();
    let tally = tally.write::<u32>();
    for found in found {
        tally[Tally::NON_FINITE] += found.non_finite;
        tally[Tally::CORRECTIONS] += found.corrections;
        tally[Tally::LIMITED] += found.limited;
        for (k, value) in found.highest.iter().enumerate() {
            let word = &mut tally[Tally::MAX_SPEED + k];
            *word = (*word).max(value.to_bits());
        }
    }
}

fn advance(
    params: &Params,
    dt: f32,
    p: Vec4,
    old: Vec4,
    rho: f32,
    a: Vec4,
    found: &mut Found,
) -> (Vec4, Vec4) {
    if p.w != 0.0 {
        return (p, old);
    }
    let mut v = old.xyz() + dt * a.xyz();
    let (step, most) = (v.length() * dt, 0.5 * params.particle_spacing);
    if step > most {
        v *= most / step;
        found.limited += 1;
    }
    let near = 0.25 * params.particle_spacing;
    let is_closed = |bit: usize| params.closed >> bit & 1 == 1;
    for axis in 0..3 {
        if is_closed(2 * axis) {
            v[axis] = v[axis].max(-(p[axis] - params.domain_min[axis] - near).max(0.0) / dt);
        }
        if is_closed(2 * axis + 1) {
            v[axis] = v[axis].min((params.domain_max[axis] - p[axis] - near).max(0.0) / dt);
        }
    }
    let mut x = p.xyz() + dt * v;
    // `max` and `min` take the other operand of a NaN, so the sum of everything is asked, not only the result.
    if !(x.is_finite() && a.is_finite() && rho.is_finite()) {
        found.non_finite += 1;
        return (p.xyz().extend(DEAD_NON_FINITE), Vec4::new(0.0, 0.0, 0.0, params.rest_density));
    }
    for axis in 0..3 {
        let (low, high) = (params.domain_min[axis], params.domain_max[axis]);
        if (is_closed(2 * axis) && x[axis] < low) || (is_closed(2 * axis + 1) && x[axis] > high) {
            x[axis] = x[axis].clamp(low, high);
            v[axis] = 0.0;
            found.corrections += 1;
        }
    }
    let values = [v.length(), a.xyz().length(), (rho / params.rest_density - 1.0).max(0.0)];
    for (highest, value) in found.highest.iter_mut().zip(values) {
        *highest = highest.max(value);
    }
    (x.extend(0.0), v.extend(rho))
}
