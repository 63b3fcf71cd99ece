//! The integration of particles on the CPU, for all passes that integrate.

use glam::{Vec3, Vec4, Vec4Swizzles};
use rayon::prelude::*;
use splashdown_gpu::WgslModule;

use crate::boundary::{closed_bounds, law};
use crate::cells::Grid;
use crate::cells::cell_counts::{self, CellCounter};
use crate::state::{DEAD_ESCAPED, DEAD_NON_FINITE, Params, StepCounters, StepState};

/// The WGSL side.
pub const WGSL: WgslModule = WgslModule { name: "sph/advance", source: include_str!("advance.wgsl") };

/// Particles per task.
const CHUNK: usize = 4096;

/// The particles before the integration, in sorted order.
#[derive(Clone, Copy)]
pub(crate) struct Before<'a> {
    pub positions: &'a [Vec4],
    pub velocities: &'a [Vec4],
}

/// What a step does to a particle.
pub(crate) struct Change {
    /// In m/s^2.
    pub acceleration: Vec3,
    /// The shifting velocity in m/s, which moves the particle only.
    pub shift: Vec3,
    /// In kg/m^3.
    pub density: f32,
}

impl Change {
    /// Without shifting.
    #[inline]
    pub fn unshifted(acceleration: Vec3, density: f32) -> Self {
        Self { acceleration, shift: Vec3::ZERO, density }
    }
}

/// The output of the integration.
pub(crate) struct Persistent<'a> {
    pub positions: &'a mut [Vec4],
    pub velocities: &'a mut [Vec4],
    pub counters: &'a mut [u32],
    pub cell_counts: &'a mut [u32],
}

/// Integrates all particles, and counts them for the next step if `counts`. `change` is called with the index of a
/// particle and the value at this index of the persistent velocities.
pub(crate) fn advance_all(
    (params, grid, state): (&Params, &Grid, &StepState),
    sorted: Before<'_>,
    persistent: Persistent<'_>,
    counts: bool,
    change: impl Fn(usize, Vec4) -> Change + Sync,
) {
    let n = state.run_count as usize;
    let mover = Mover::new(params, grid, state.dt);
    // After the last step of a frame no step follows that needs the count.
    let counting = counts && !state.is_last_step();
    let (counts, cells) = cell_counts::split(grid, persistent.cell_counts);
    let found: Vec<ChunkCounters> = sorted.positions[..n]
        .par_chunks(CHUNK)
        .zip(sorted.velocities[..n].par_chunks(CHUNK))
        .zip(persistent.positions[..n].par_chunks_mut(CHUNK))
        .zip(persistent.velocities[..n].par_chunks_mut(CHUNK))
        .zip(cells[..n].par_chunks_mut(CHUNK))
        .enumerate()
        .map(|(chunk, ((((p, v), new_p), new_v), cells))| {
            let mut found = ChunkCounters::default();
            let mut counter = CellCounter::new(counts);
            for k in 0..p.len() {
                let change = change(chunk * CHUNK + k, new_v[k]);
                let moved = mover.advance(p[k], v[k], &change, &mut found);
                (new_p[k], new_v[k]) = (moved.position, moved.velocity);
                if counting {
                    cells[k] = moved.cell;
                    counter.add(moved.cell);
                }
            }
            found
        })
        .collect();
    ChunkCounters::add_all(&found, params, persistent.counters);
}

/// The contribution of a chunk of particles to the counters.
#[derive(Default)]
struct ChunkCounters {
    escaped: u32,
    non_finite: u32,
    corrections: u32,
    limited: u32,
    /// Maxima of the squares of speed and acceleration, and of the density.
    highest: [f32; 3],
}

impl ChunkCounters {
    /// Adds the contributions of all chunks to the counters, and marks that particles have moved.
    fn add_all(all: &[Self], params: &Params, counters: &mut [u32]) {
        for found in all {
            counters[StepCounters::ESCAPED] += found.escaped;
            counters[StepCounters::NON_FINITE] += found.non_finite;
            counters[StepCounters::CORRECTIONS] += found.corrections;
            counters[StepCounters::LIMITED] += found.limited;
            // Roots and quotients are monotonic, so that they are computed of the maxima only.
            let [speed2, acceleration2, density] = found.highest;
            let excess = (density / params.rest_density - 1.0).max(0.0);
            for (k, value) in [speed2.sqrt(), acceleration2.sqrt(), excess].into_iter().enumerate() {
                let word = &mut counters[StepCounters::MAX_SPEED + k];
                *word = (*word).max(value.to_bits());
            }
        }
        counters[StepCounters::MOVED] = 1;
    }
}

/// The state of a particle after a step.
struct Moved {
    position: Vec4,
    velocity: Vec4,
    cell: u32,
}

/// The largest distance by which the shifting moves a particle per step in addition, in spacings.
const LONGEST_SHIFT: f32 = 0.1;

/// Integrates particles over one step.
struct Mover<'a> {
    params: &'a Params,
    grid: &'a Grid,
    dt: f32,
    /// The corners of the domain, infinite where it is open.
    low: Vec3,
    high: Vec3,
    /// The corners of the box from which no side can be reached in one step.
    inner: [Vec3; 2],
}

impl<'a> Mover<'a> {
    fn new(params: &'a Params, grid: &'a Grid, dt: f32) -> Self {
        let [low, high] = closed_bounds(params.domain_min, params.domain_max, params.closed);
        let margin =
            1.01 * (params.longest_motion + LONGEST_SHIFT + law::CLEARANCE) * params.particle_spacing;
        let inner = [params.domain_min + margin, params.domain_max - margin];
        Self { params, grid, dt, low, high, inner }
    }

    /// Integrates a particle, given its position and velocity.
    #[inline]
    fn advance(&self, p: Vec4, old: Vec4, change: &Change, found: &mut ChunkCounters) -> Moved {
        let Self { params, grid, dt, low, high, inner } = *self;
        let Change { acceleration: a, shift, density: rho } = *change;
        if p.w != 0.0 {
            return Moved { position: p, velocity: old, cell: grid.cell_count };
        }
        let mut v = old.xyz() + dt * a;
        let (step, most) = (v.length() * dt, params.longest_motion * params.particle_spacing);
        if step > most {
            v *= most / step;
            found.limited += 1;
        }
        let p = p.xyz();
        let is_inner = p.cmpgt(inner[0]).all() && p.cmplt(inner[1]).all();
        // A wall limits the velocity, and its sum with the shifting.
        let mut motion = v + shift.clamp_length_max(LONGEST_SHIFT * params.particle_spacing / dt);
        if !is_inner {
            let slowest = -law::contact_speeds(params, p - low, dt);
            let fastest = law::contact_speeds(params, high - p, dt);
            v = v.max(slowest).min(fastest);
            motion = motion.max(slowest).min(fastest);
        }
        let mut x = p + dt * motion;
        // `max` and `min` ignore a NaN operand, so the acceleration and the density are tested in addition to the result.
        if !(x.is_finite() && a.is_finite() && rho.is_finite()) {
            found.non_finite += 1;
            return Moved {
                position: p.extend(DEAD_NON_FINITE),
                velocity: Vec4::new(0.0, 0.0, 0.0, params.rest_density),
                cell: grid.cell_count,
            };
        }
        let beyond = x.cmplt(low) | x.cmpgt(high);
        if !is_inner && beyond.any() {
            x = x.clamp(low, high);
            v = Vec3::select(beyond, Vec3::ZERO, v);
            found.corrections += beyond.bitmask().count_ones();
        }
        let values = [v.length_squared(), a.length_squared(), rho];
        for (highest, value) in found.highest.iter_mut().zip(values) {
            *highest = highest.max(value);
        }
        let velocity = v.extend(rho);
        if !is_inner && params.is_outside(x) {
            found.escaped += 1;
            return Moved { position: x.extend(DEAD_ESCAPED), velocity, cell: grid.cell_count };
        }
        Moved { position: x.extend(0.0), velocity, cell: grid.cell_of(x) }
    }
}
