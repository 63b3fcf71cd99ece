//! The monitor of a simulation: an energy balance, the density by positions, and the watch over values that must stay
//! within bounds.
//!
//! *How it works.* Once per frame the host has the particles. It computes the [`EnergyBalance`] and the
//! [`DensityError`], and compares every quantity of [`Watched`] with the bounds of its levels. A quantity is reported when
//! it rises to a new level, and again whenever it doubles above a warning. The steps are not affected: what must be summed
//! in every step (the work of bodies) is summed by a pass that has the numbers anyway.
//!
//! *The largest speed that energy allows* is `sqrt(v0^2 + 2 g h + (2 u)^2)` plus the speed of shaking.
//!
//! * v0 is the largest initial speed of fluid, apart from single fast particles (`outliers`), and the largest speed of
//!   emitters.
//! * h is the height of the fluid above the lowest corner: of the whole domain with dynamic bodies, more with surface tension
//!   and adhesion.
//! * u is the speed of the fastest point of scripted bodies that came near the fluid so far, and of dynamic bodies at the
//!   start; a wall that moves at u reflects fluid at 2 u. A jump does not count as a speed: it would allow any.

mod area;
mod density;
mod energy;
mod levels;
mod outliers;
mod scripted;
#[cfg(test)]
mod tests;
mod words;

pub use density::DensityError;
pub use energy::EnergyBalance;
pub use levels::{Level, Watched};

use glam::Vec3;
use serde::{Deserialize, Serialize};
use splashdown_io::Particles;

use self::energy::{EnergyAccount, SavedEnergy};
use self::outliers::Outliers;
use self::scripted::ScriptedBodies;
use self::words::{Context, Rise};
use crate::scene::{Derived, Motion, Scene};
use crate::state::Params;
use crate::{BodyMesh, BodyState, Stats};

/// Particles overlap at the start if the largest excess of density is above this, the tolerance of the initial packing.
const DENSE_START: f32 = 0.02;

/// A quantity that has risen to a new level.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Alarm {
    /// The new level.
    pub level: Level,
    /// The quantity.
    pub watched: Watched,
    /// Its value; [`Watched`] has the units.
    pub value: f64,
    /// The value from which on it has this level.
    pub limit: f64,
    /// Simulated time in s.
    pub time: f64,
    /// Where, in m; `None` if there is no single place.
    pub place: Option<[f32; 3]>,
    /// For people: what is wrong, where, since when, the likely cause, and what to change.
    pub message: String,
}

/// The findings of a frame.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct Findings {
    /// The energy balance.
    pub energy: EnergyBalance,
    /// The density by positions.
    pub density: DensityError,
    /// Quantities that have risen.
    pub alarms: Vec<Alarm>,
}

/// The state at the end of a frame.
#[derive(Clone, Copy)]
pub struct Observed<'a> {
    /// Simulated time in s.
    pub time: f64,
    /// The statistics, with the particles inside bodies.
    pub stats: &'a Stats,
    /// The particles in order of their ids.
    pub particles: &'a Particles,
    /// The bodies.
    pub bodies: &'a [BodyState],
    /// The distance in m from a point to the nearest body, and its name.
    pub nearest: &'a (dyn Fn(Vec3) -> Option<(f32, &'a str)> + Sync),
}

/// Watches a simulation.
#[derive(Clone, Debug)]
pub struct Monitor {
    params: Params,
    context: Context,
    account: EnergyAccount,
    /// Reference speed in m/s, without moving bodies.
    reference_speed: f64,
    /// The same without the initial speeds of the fluid.
    driven_speed: f64,
    /// The largest speed of an emitter in m/s.
    emitted_speed: f64,
    outliers: Outliers,
    scripted: ScriptedBodies,
    /// The largest speed of a scripted body so far, and of dynamic bodies at the start, in m/s.
    body_speed: f64,
    before: Counted,
    /// For each quantity: the level, and the value of the last report.
    reported: Vec<(Level, f64)>,
    level: Level,
}

/// Counters at the last frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Counted {
    corrections: u32,
    limited: u32,
}

/// The part of a monitor that a checkpoint stores.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct SavedMonitor {
    energy: SavedEnergy,
    reference_speed: f64,
    outliers: Outliers,
    body_speed: f64,
    before: Counted,
    reported: Vec<(Level, f64)>,
    level: Level,
}

impl Monitor {
    /// A monitor of a simulation of this scene, with its constants and the meshes of its bodies.
    pub fn new(scene: &Scene, params: &Params, meshes: &[BodyMesh]) -> Self {
        let derived = Derived::without_particles(scene);
        let reach =
            |mesh: &BodyMesh| mesh.mesh.vertices.iter().map(|&x| Vec3::from(x).length()).fold(0.0, f32::max);
        let is_scripted = |motion: &Motion| matches!(motion, Motion::Scripted(_));
        let reaches = scene
            .bodies
            .iter()
            .zip(meshes)
            .map(|(body, mesh)| is_scripted(&body.motion).then(|| reach(mesh)));
        let initial = scene.bodies.iter().zip(meshes).map(|(body, mesh)| match &body.motion {
            Motion::Dynamic { velocity, angular_velocity, .. } => {
                velocity.length() + angular_velocity.length() * reach(mesh)
            }
            _ => 0.0,
        });
        let body_speed = f64::from(initial.fold(0.0, f32::max));
        // Dynamic bodies may fall through the whole domain.
        let has_dynamic = scene.bodies.iter().any(|body| matches!(body.motion, Motion::Dynamic { .. }));
        let whole = if has_dynamic { (scene.gravity.abs() * scene.domain.size()).element_sum() } else { 0.0 };
        let fall = scene.gravity.length() * derived.head;
        let shaking = scene.domain.oscillation.map_or(0.0, |oscillation| oscillation.max_speed());
        let initial = ((derived.reference_speed - shaking).powi(2) - 4.0 * fall).max(0.0);
        let emitted = scene.emitters.iter().map(|emitter| emitter.speed).fold(0.0, f32::max);
        let attraction = 4.0 * energy::attraction_energy(scene);
        let noticeable = energy::noticeable_speed(scene, derived.reference_speed.into());
        let with = |initial: f32| {
            let square = f64::from(initial + 2.0 * fall.max(whole)) + attraction;
            (square.sqrt() + f64::from(shaking)).max(noticeable)
        };
        Self {
            params: *params,
            context: Context::new(scene, params.sound_speed, derived.reference_speed),
            account: EnergyAccount::new(scene, params, derived.reference_speed.into()),
            reference_speed: with(initial),
            driven_speed: with(initial.min(emitted * emitted)),
            emitted_speed: emitted.into(),
            outliers: Outliers::default(),
            scripted: ScriptedBodies::new(reaches.collect(), params.support_radius),
            body_speed,
            before: Counted::default(),
            reported: vec![(Level::Sound, 0.0); Watched::ALL.len()],
            level: Level::Sound,
        }
    }

    /// The highest level so far.
    pub fn level(&self) -> Level {
        self.level
    }

    /// The state for a checkpoint.
    pub(crate) fn save(&self) -> SavedMonitor {
        let Self { reference_speed, body_speed, before, level, .. } = *self;
        SavedMonitor {
            energy: self.account.save(),
            reference_speed,
            outliers: self.outliers.clone(),
            body_speed,
            before,
            reported: self.reported.clone(),
            level,
        }
    }

    /// Continues from a checkpoint with the particles and bodies of its frame.
    pub(crate) fn restore(
        &mut self,
        saved: SavedMonitor,
        time: f64,
        particles: &Particles,
        bodies: &[BodyState],
    ) {
        self.account.restore(saved.energy, time, particles, work(bodies));
        self.scripted.begin(time, bodies);
        (self.reference_speed, self.outliers) = (saved.reference_speed, saved.outliers);
        (self.body_speed, self.before, self.level) = (saved.body_speed, saved.before, saved.level);
        for (own, saved) in self.reported.iter_mut().zip(saved.reported) {
            *own = saved;
        }
    }

    /// Examines the next frame.
    pub fn observe(&mut self, observed: Observed<'_>) -> Findings {
        let Observed { time, stats, particles, bodies, nearest } = observed;
        let mut alarms = Vec::new();
        if stats.steps == 0 {
            alarms.extend(self.find_outliers(time, particles));
        }
        let energy = self.account.add(time, particles, work(bodies));
        let distance = |x: Vec3| nearest(x).map(|(distance, _)| distance);
        let density = density::density_error(&self.params, &particles.positions, stats.steps, &distance);
        if stats.steps == 0 {
            self.context.starts_dense = Some(density.largest > DENSE_START);
        }
        self.body_speed = self.scripted.fastest(time, bodies, &particles.positions, self.body_speed);
        let allowed = (self.reference_speed.powi(2) + 4.0 * self.body_speed.powi(2)).sqrt();
        let (fastest, fast, fastest_place) = speeds(particles, &self.outliers);
        let counted = Counted { corrections: stats.wall_corrections, limited: stats.speed_limits };
        let since = |now: u32, before: u32| f64::from(now.saturating_sub(before));
        let place = |x: [f32; 3]| Some(Vec3::from(x)).filter(|x| x.is_finite());
        let lost = f64::from(stats.non_finite);
        let values = Watched::ALL.map(|watched| match watched {
            Watched::Speed => (fastest / allowed, fastest_place),
            Watched::FastPart => (fast / allowed, fastest_place),
            Watched::EnergyGain => (energy.gain(), fastest_place),
            // An implicit pressure lets single particles exceed it in every impact; the run warns of its mean.
            Watched::Compression if self.params.is_implicit == 1 => (0.0, None),
            Watched::Compression => (stats.density_error.into(), place(density.largest_place)),
            Watched::DensePart => (density.excess.into(), place(density.largest_place)),
            Watched::ThinPart => (density.deficit.into(), place(density.deficit_place)),
            Watched::WallCorrections => {
                let count = since(counted.corrections, self.before.corrections);
                (count, deepest(particles, nearest, count > 0.0))
            }
            Watched::InsideBodies => {
                let count = stats.inside_bodies;
                (f64::from(count), deepest(particles, nearest, count > 0))
            }
            Watched::NonFinite if stats.non_finite > 0 => (lost, place(stats.non_finite_place)),
            Watched::NonFinite => (lost, None),
            Watched::SpeedLimits => (since(counted.limited, self.before.limited), fastest_place),
        });
        self.before = counted;
        for (k, (&watched, (value, place))) in Watched::ALL.iter().zip(values).enumerate() {
            let count = particles.positions.len();
            let level = watched.level(value, count);
            let (last, reported) = self.reported[k];
            let is_new = level > last || (level >= Level::Warning && value >= 2.0 * reported);
            if !is_new || level == Level::Sound {
                continue;
            }
            self.reported[k] = (level.max(last), value);
            self.level = self.level.max(level);
            let body = place.and_then(nearest);
            let rise = Rise { watched, value, time, place, body, allowed_speed: allowed };
            let limits = watched.limits(count);
            alarms.push(Alarm {
                level,
                watched,
                value,
                limit: limits[(level as usize).saturating_sub(1)],
                time,
                place: place.map(Into::into),
                message: self.context.message(&rise),
            });
        }
        alarms.sort_by_key(|alarm| std::cmp::Reverse(alarm.level));
        Findings { energy, density, alarms }
    }

    /// Separates single particles that start much faster than the others, and reports them. The others may be faster than
    /// the scene says: those of a program.
    fn find_outliers(&mut self, time: f64, particles: &Particles) -> Option<Alarm> {
        let (outliers, others) = Outliers::find(particles, self.driven_speed, self.emitted_speed)?;
        if outliers.ids().is_empty() {
            self.reference_speed = self.reference_speed.max(others);
            return None;
        }
        let first =
            outliers.ids().first().and_then(|id| particles.ids.iter().position(|other| other == id))?;
        let speed = f64::from(Vec3::from(particles.velocities[first]).length());
        let place = particles.positions[first];
        self.reference_speed = others;
        self.account.set_reference_speed(others);
        let level = Level::Warning;
        self.level = self.level.max(level);
        let limit = outliers::MUCH_FASTER;
        let message = words::outliers(outliers.ids().len(), speed, others, place.into());
        self.outliers = outliers;
        let place = Some(place);
        Some(Alarm { level, watched: Watched::Speed, value: speed / others, limit, time, place, message })
    }
}

/// The work of all bodies on the fluid since the start in J.
fn work(bodies: &[BodyState]) -> f64 {
    bodies.iter().map(|body| f64::from(body.work)).sum()
}

/// The largest speed in m/s, the speed that one particle in a hundred exceeds, and where the fastest is. Outliers have none.
fn speeds(particles: &Particles, outliers: &Outliers) -> (f64, f64, Option<Vec3>) {
    let mut squares: Vec<f32> =
        particles.velocities.iter().map(|&v| Vec3::from(v).length_squared()).collect();
    for (square, id) in squares.iter_mut().zip(&particles.ids) {
        if outliers.contain(*id) {
            *square = 0.0;
        }
    }
    let fastest = squares.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1));
    let Some((place, &fastest)) = fastest else { return (0.0, 0.0, None) };
    let mut sorted = squares.clone();
    let at = sorted.len() / 100;
    let (_, &mut fast, _) = sorted.select_nth_unstable_by(at, |a, b| b.total_cmp(a));
    (f64::from(fastest).sqrt(), f64::from(fast).sqrt(), Some(particles.positions[place].into()))
}

/// The position of the particle that is deepest inside a body, or nearest to one, if `wanted`.
fn deepest<'a>(
    particles: &Particles,
    nearest: &(dyn Fn(Vec3) -> Option<(f32, &'a str)> + Sync),
    wanted: bool,
) -> Option<Vec3> {
    let positions = particles.positions.iter().map(|&x| Vec3::from(x)).filter(|_| wanted);
    let distances = positions.filter_map(|x| nearest(x).map(|(distance, _)| (distance, x)));
    distances.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, x)| x)
}
