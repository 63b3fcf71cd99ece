//! The motion of particles on the CPU, for all passes that move some.

use std::sync::atomic::AtomicU32;
use std::sync::atomic::Ordering::Relaxed;

use glam::{Vec3, Vec4, Vec4Swizzles};
use splashdown_gpu::WgslModule;

use super::{DEAD_ESCAPED, DEAD_NON_FINITE, Params, Tally};
use crate::cells::Grid;

/// The WGSL side.
pub const WGSL: WgslModule = WgslModule { name: "sph/moving", source: include_str!("moving.wgsl") };

/// What a group of particles adds to the tally.
#[derive(Default)]
pub(crate) struct Found {
    escaped: u32,
    non_finite: u32,
    corrections: u32,
    limited: u32,
    /// Speed, acceleration, excess of density.
    highest: [f32; 3],
}

impl Found {
    /// Puts what all groups found into the tally, and that particles have moved.
    pub fn tell(all: &[Self], tally: &mut [u32]) {
        for found in all {
            tally[Tally::ESCAPED] += found.escaped;
            tally[Tally::NON_FINITE] += found.non_finite;
            tally[Tally::CORRECTIONS] += found.corrections;
            tally[Tally::LIMITED] += found.limited;
            for (k, value) in found.highest.iter().enumerate() {
                let word = &mut tally[Tally::MAX_SPEED + k];
                *word = (*word).max(value.to_bits());
            }
        }
        Self::tell_moved(tally);
    }

    /// Puts into the tally that particles have moved.
    pub fn tell_moved(tally: &mut [u32]) {
        tally[Tally::MOVED] = 1;
    }

    /// Puts what a particle found into the tally, beside other threads: a maximum is only written where it rises, which
    /// soon it seldom does.
    #[inline]
    pub fn tell_at_once(&self, tally: &[AtomicU32]) {
        for (k, value) in self.highest.iter().enumerate() {
            let word = &tally[Tally::MAX_SPEED + k];
            if value.to_bits() > word.load(Relaxed) {
                word.fetch_max(value.to_bits(), Relaxed);
            }
        }
        let counts = [
            (Tally::ESCAPED, self.escaped),
            (Tally::NON_FINITE, self.non_finite),
            (Tally::CORRECTIONS, self.corrections),
            (Tally::LIMITED, self.limited),
        ];
        for (word, count) in counts.into_iter().filter(|(_, count)| *count > 0) {
            tally[word].fetch_add(count, Relaxed);
        }
    }
}

/// What a particle is after a step.
pub(crate) struct Moved {
    pub position: Vec4,
    pub velocity: Vec4,
    pub cell: u32,
}

/// Moves a particle, given its position, velocity, density in kg/m^3 and acceleration.
#[inline]
pub(crate) fn advance(
    params: &Params,
    grid: &Grid,
    dt: f32,
    (p, old, rho, a): (Vec4, Vec4, f32, Vec3),
    found: &mut Found,
) -> Moved {
    if p.w != 0.0 {
        return Moved { position: p, velocity: old, cell: grid.cell_count };
    }
    let mut v = old.xyz() + dt * a;
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
        return Moved {
            position: p.xyz().extend(DEAD_NON_FINITE),
            velocity: Vec4::new(0.0, 0.0, 0.0, params.rest_density),
            cell: grid.cell_count,
        };
    }
    for axis in 0..3 {
        let (low, high) = (params.domain_min[axis], params.domain_max[axis]);
        if (is_closed(2 * axis) && x[axis] < low) || (is_closed(2 * axis + 1) && x[axis] > high) {
            x[axis] = x[axis].clamp(low, high);
            v[axis] = 0.0;
            found.corrections += 1;
        }
    }
    let values = [v.length(), a.length(), (rho / params.rest_density - 1.0).max(0.0)];
    for (highest, value) in found.highest.iter_mut().zip(values) {
        *highest = highest.max(value);
    }
    let velocity = v.extend(rho);
    if params.is_outside(x) {
        found.escaped += 1;
        return Moved { position: x.extend(DEAD_ESCAPED), velocity, cell: grid.cell_count };
    }
    Moved { position: x.extend(0.0), velocity, cell: grid.cell_of(x) }
}
