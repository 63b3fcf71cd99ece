//! The motion of particles on the CPU, for all passes that move some.

use glam::{Vec2, Vec3, Vec4, Vec4Swizzles};
use rayon::prelude::*;
use splashdown_gpu::WgslModule;

use super::{DEAD_ESCAPED, DEAD_NON_FINITE, Params, StepState, Tally};
use crate::cells::Grid;
use crate::cells::census::{self, Enroller};

/// The WGSL side.
pub const WGSL: WgslModule = WgslModule { name: "sph/moving", source: include_str!("moving.wgsl") };

/// Particles per task.
const CHUNK: usize = 4096;

/// The particles as a step's sort left them: positions, velocities, densities.
#[derive(Clone, Copy)]
pub(crate) struct Sorted<'a> {
    pub positions: &'a [Vec4],
    pub velocities: &'a [Vec4],
    pub densities: &'a [Vec2],
}

/// Where they go.
pub(crate) struct Resting<'a> {
    pub positions: &'a mut [Vec4],
    pub velocities: &'a mut [Vec4],
    pub tally: &'a mut [u32],
    pub census: &'a mut [u32],
}

/// Moves all particles, and counts them for the next step if `counts`. The acceleration of a particle is that of its number, and
/// of what stands at its place in the resting velocities.
pub(crate) fn advance_all(
    (params, grid, state): (&Params, &Grid, &StepState),
    sorted: Sorted<'_>,
    resting: Resting<'_>,
    counts: bool,
    acceleration: impl Fn(usize, Vec4) -> Vec3 + Sync,
) {
    let n = state.run_count as usize;
    // After the last step of a frame there is no next one to count for.
    let counting = counts && !state.is_last_step();
    let (counts, cells) = census::split(grid, resting.census);
    let found: Vec<Found> = sorted.positions[..n]
        .par_chunks(CHUNK)
        .zip(sorted.velocities[..n].par_chunks(CHUNK))
        .zip(sorted.densities[..n].par_chunks(CHUNK))
        .zip(resting.positions[..n].par_chunks_mut(CHUNK))
        .zip(resting.velocities[..n].par_chunks_mut(CHUNK))
        .zip(cells[..n].par_chunks_mut(CHUNK))
        .enumerate()
        .map(|(chunk, (((((p, v), density), new_p), new_v), cells))| {
            let mut found = Found::default();
            let mut enroller = Enroller::new(counts);
            for k in 0..p.len() {
                let a = acceleration(chunk * CHUNK + k, new_v[k]);
                let particle = (p[k], v[k], density[k].x, a);
                let moved = advance(params, grid, state.dt, particle, &mut found);
                (new_p[k], new_v[k]) = (moved.position, moved.velocity);
                if counting {
                    cells[k] = moved.cell;
                    enroller.add(moved.cell);
                }
            }
            found
        })
        .collect();
    Found::tell(&found, resting.tally);
}

/// What a group of particles adds to the tally.
#[derive(Default)]
struct Found {
    escaped: u32,
    non_finite: u32,
    corrections: u32,
    limited: u32,
    /// Speed, acceleration, excess of density.
    highest: [f32; 3],
}

impl Found {
    /// Puts what all groups found into the tally, and that particles have moved.
    fn tell(all: &[Self], tally: &mut [u32]) {
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
        tally[Tally::MOVED] = 1;
    }
}

/// What a particle is after a step.
struct Moved {
    position: Vec4,
    velocity: Vec4,
    cell: u32,
}

/// Moves a particle, given its position, velocity, density in kg/m^3 and acceleration.
#[inline]
fn advance(
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
