//! The energy balance of the fluid.
//!
//! *Terms.* Kinetic, potential and elastic energy are sums over the particles of a frame. The work of bodies is summed on
//! the device in every step, from the force and torque that the step has summed already (`bodies/motion`). The work of
//! shaking is the integral of the domain's acceleration times the momentum of the fluid over a frame; the momentum is
//! interpolated so that its integral is the displacement of the centre of mass. Emitted fluid brings its energy and the
//! work p V against the pressure at the nozzle; energy that appears in frames with emission is attributed to the nozzle. Fluid that leaves takes the energy that it had in the frame before, which
//! a fall does not change. The remainder is what viscosity, walls and the numerical method have dissipated; it is
//! negative where they have created energy.
//!
//! *Bound.* Where nothing dissipates, the remainder is below 1 % of the energy that takes part until the end of the run
//! (`tests.rs`: free fall, a block that is shaken, a jet into a sink).

use glam::DVec3;
use serde::{Deserialize, Serialize};
use splashdown_io::Particles;

use super::area;
use crate::scene::{MIN_SPEED, Scene, SurfaceTension};
use crate::state::Params;

/// The energy of the fluid in a frame, and what has changed it since the start; all in J.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct EnergyBalance {
    /// Kinetic energy.
    pub kinetic: f64,
    /// Potential energy relative to the lowest corner of the domain.
    pub potential: f64,
    /// Energy of compression.
    pub elastic: f64,
    /// Work of bodies on the fluid since the start.
    pub bodies: f64,
    /// Work of the shaking domain since the start.
    pub shaking: f64,
    /// Energy of the fluid from emitters since the start, with their work against its pressure.
    pub emitted: f64,
    /// Energy of the fluid that sinks, open sides and the removal of invalid particles have taken since the start.
    pub removed: f64,
    /// Energy that viscosity, walls and the numerical method have dissipated since the start: the remainder of the
    /// balance. Negative if they have created energy.
    pub dissipated: f64,
    /// Kinetic and potential energy above those of the start and the sources: energy of compression that overlapping
    /// particles have released. Negative in a sound run.
    pub released: f64,
    /// The energy that could become kinetic: that of the start above fluid at rest on the lowest level, that of the surface,
    /// and the sizes of all work since. The scale of errors.
    pub available: f64,
    /// An estimate of the energy of the surface at the start with `surface_tension = "csf"`. It can become kinetic, and is not
    /// a term of the balance.
    pub surface: f64,
}

impl EnergyBalance {
    /// The terms of the balance: kinetic + potential + elastic = those of the start + bodies + shaking + emitted - removed
    /// - dissipated. The order is that of the columns of a probe of the balance.
    pub fn terms(&self) -> [f64; 8] {
        let Self { kinetic, potential, elastic, bodies, shaking, emitted, removed, dissipated, .. } = *self;
        [kinetic, potential, elastic, bodies, shaking, emitted, removed, dissipated]
    }

    /// Kinetic, potential and elastic energy.
    pub fn total(&self) -> f64 {
        self.kinetic + self.potential + self.elastic
    }

    /// The energy that was created without a source or released by overlapping particles, beyond that of the surface, as a
    /// fraction of what is available: zero in a sound run.
    pub fn gain(&self) -> f64 {
        let created = (-self.dissipated).max(self.released) - self.surface;
        created.max(0.0) / self.available.max(f64::MIN_POSITIVE)
    }
}

/// The mean emission of a nozzle: its outlet in m and its speed in m/s.
#[derive(Clone, Copy, Debug)]
struct Source {
    position: DVec3,
    speed: f64,
}

/// What the account remembers of the frame before.
#[derive(Clone, Debug)]
struct Before {
    time: f64,
    ids: Vec<u32>,
    positions: Vec<[f32; 3]>,
    velocities: Vec<[f32; 3]>,
    elastic: Vec<f64>,
    bodies: f64,
}

/// Keeps the balance from frame to frame.
#[derive(Clone, Debug)]
pub(super) struct EnergyAccount {
    params: Params,
    mass: f64,
    gravity: DVec3,
    /// gravity . x of the lowest corner of the domain.
    lowest: f64,
    /// Amplitude of the acceleration by shaking in m/s^2, and its rate in rad/s.
    shaking: (DVec3, f64),
    sources: Vec<Source>,
    /// Kinetic energy per mass that always counts as available, in m^2/s^2.
    least: f64,
    /// The part of it that attraction between particles or by bodies can release.
    attraction: f64,
    /// The tension of the surface in N/m with `csf`, and the cosine of the contact angle.
    tension: [f64; 2],
    /// Total energy at the start, and its part without compression, in J.
    start: Option<[f64; 2]>,
    balance: EnergyBalance,
    before: Option<Before>,
}

/// The part of an account that a checkpoint stores.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct SavedEnergy {
    /// Total energy at the start, and its part without compression, in J.
    start: Option<[f64; 2]>,
    balance: EnergyBalance,
}

/// The speed in m/s below which motions are not a burst where nothing drives the fluid: that at which it moves by two spacings
/// in the time of the scene. Zero where something drives it.
pub(super) fn noticeable_speed(scene: &Scene, reference_speed: f64) -> f64 {
    if reference_speed > f64::from(MIN_SPEED) {
        return 0.0;
    }
    2.0 * f64::from(scene.fluid.particle_spacing) / f64::from(scene.duration).max(f64::MIN_POSITIVE)
}

impl EnergyAccount {
    pub fn new(scene: &Scene, params: &Params, reference_speed: f64) -> Self {
        let gravity = params.gravity.as_dvec3();
        let (min, max) = (params.domain_min.as_dvec3(), params.domain_max.as_dvec3());
        let corner = DVec3::select(gravity.cmpgt(DVec3::ZERO), max, min);
        let source = |emitter: &crate::scene::Emitter| Source {
            position: emitter.position.as_dvec3(),
            speed: emitter.speed.into(),
        };
        let has_csf = scene.solver.surface_tension == SurfaceTension::Csf;
        // The energy of csf follows from the area of the surface, that of other models only from a bound.
        let attraction = adhesion_energy(scene) + if has_csf { 0.0 } else { tension_energy(scene) };
        let tension = if has_csf { scene.fluid.material.surface_tension.into() } else { 0.0 };
        Self {
            mass: params.particle_mass.into(),
            gravity,
            lowest: gravity.dot(corner),
            shaking: (params.oscillation.as_dvec3(), params.oscillation_rate.into()),
            sources: scene.emitters.iter().map(source).collect(),
            least: 0.5 * (0.05 * reference_speed).max(noticeable_speed(scene, reference_speed)).powi(2)
                + attraction,
            attraction,
            tension: [tension, f64::from(scene.solver.contact_angle).to_radians().cos()],
            start: None,
            balance: EnergyBalance::default(),
            before: None,
            params: *params,
        }
    }

    /// Before the first frame: the reference speed in m/s without outliers.
    pub fn set_reference_speed(&mut self, speed: f64) {
        self.least = self.least.min(0.5 * (0.05 * speed).powi(2) + self.attraction);
    }

    pub fn save(&self) -> SavedEnergy {
        SavedEnergy { start: self.start, balance: self.balance }
    }

    /// Continues the balance of a checkpoint with the particles of its frame.
    pub fn restore(&mut self, saved: SavedEnergy, time: f64, particles: &Particles, bodies: f64) {
        (self.start, self.balance) = (saved.start, saved.balance);
        let elastic = self.elastic(particles);
        self.before = Some(remember(time, particles, elastic, bodies));
    }

    /// The balance of the next frame. `bodies` is the work of all bodies since the start of the simulation in J.
    pub fn add(&mut self, time: f64, particles: &Particles, bodies: f64) -> EnergyBalance {
        let elastic = self.elastic(particles);
        let (mut squares, mut depth) = (0.0, 0.0);
        for (&x, &v) in particles.positions.iter().zip(&particles.velocities) {
            squares += vector(v).length_squared();
            depth += self.lowest - self.gravity.dot(vector(x));
        }
        let balance = &mut self.balance;
        balance.kinetic = 0.5 * self.mass * squares;
        balance.potential = self.mass * depth;
        balance.elastic = elastic.iter().sum();
        match &self.before {
            Some(before) => {
                let change = self.change(before, time, particles, &elastic);
                let work = bodies - before.bodies;
                let is_emitting = change.emitted > 0.0;
                let balance = &mut self.balance;
                balance.bodies += work;
                balance.shaking += change.shaking;
                balance.emitted += change.emitted;
                balance.removed += change.removed;
                // A nozzle also does work on the fluid that it holds and meets. It is not measured: energy that appears
                // while a nozzle is active is attributed to it.
                let sources = balance.bodies + balance.shaking + balance.emitted - balance.removed;
                let [start, mechanical] = self.start.unwrap_or_default();
                let remainder = start + sources - balance.total();
                let released = balance.kinetic + balance.potential - mechanical - sources;
                let pushed = (balance.dissipated - remainder).max(released - balance.released).max(0.0);
                if is_emitting {
                    balance.emitted += pushed;
                    balance.available += pushed;
                }
                balance.available += work.abs() + change.shaking.abs() + change.emitted.abs();
            }
            None => {
                let least = self.least * self.mass * particles.positions.len() as f64;
                let [tension, cosine] = self.tension;
                balance.surface = if tension > 0.0 {
                    area::surface_energy(&self.params, &particles.positions, tension, cosine)
                } else {
                    0.0
                };
                balance.available = balance.kinetic + balance.potential + balance.surface + least;
                self.start = Some([balance.total(), balance.kinetic + balance.potential]);
            }
        }
        let balance = &mut self.balance;
        let sources = balance.bodies + balance.shaking + balance.emitted - balance.removed;
        let [start, mechanical] = self.start.unwrap_or_default();
        balance.dissipated = start + sources - balance.total();
        balance.released = balance.kinetic + balance.potential - mechanical - sources;
        self.before = Some(remember(time, particles, elastic, bodies));
        *balance
    }

    /// The energies of compression of the particles in J: m times the integral of p / rho^2 from the rest density.
    fn elastic(&self, particles: &Particles) -> Vec<f64> {
        let Params { rest_density, sound_speed, exponent, clamp_pressure, is_implicit, .. } = self.params;
        let stiffness = f64::from(sound_speed).powi(2) / f64::from(exponent);
        let n = f64::from(exponent);
        // A fluid with implicit pressure is incompressible.
        if is_implicit == 1 {
            return vec![0.0; particles.positions.len()];
        }
        let energy = |&density: &f32| {
            let x = f64::from(density) / f64::from(rest_density);
            if x.is_nan() || x <= 0.0 || (clamp_pressure == 1 && x < 1.0) {
                return 0.0;
            }
            let specific = if (n - 1.0).abs() < 1e-6 {
                x.ln() + 1.0 / x - 1.0
            } else {
                (x.powf(n - 1.0) - n) / (n - 1.0) + 1.0 / x
            };
            self.mass * stiffness * specific
        };
        particles.densities.iter().map(energy).collect()
    }

    /// What happened between two frames. Both lists of particles are in order of their ids.
    fn change(&self, before: &Before, time: f64, particles: &Particles, elastic: &[f64]) -> Change {
        let mut change = Change::default();
        let (mut first, mut last, mut moved) = (DVec3::ZERO, DVec3::ZERO, DVec3::ZERO);
        let mut k = 0;
        for (i, &id) in particles.ids.iter().enumerate() {
            while before.ids.get(k).is_some_and(|&old| old < id) {
                change.removed += self.energy(before, k);
                k += 1;
            }
            if before.ids.get(k) == Some(&id) {
                first += vector(before.velocities[k]);
                last += vector(particles.velocities[i]);
                moved += vector(particles.positions[i]) - vector(before.positions[k]);
                k += 1;
            } else {
                change.emitted += self.emitted(particles, i, elastic);
            }
        }
        change.removed += (k..before.ids.len()).map(|k| self.energy(before, k)).sum::<f64>();
        let (amplitude, rate) = self.shaking;
        let passed = time - before.time;
        if amplitude != DVec3::ZERO && passed > 0.0 {
            // A parabola through both velocities whose integral is the displacement, and Gauss's rule of three points.
            let bulge = moved / passed - 0.5 * (first + last);
            for (s, weight) in [(0.5 - 0.15_f64.sqrt(), 5.0), (0.5, 8.0), (0.5 + 0.15_f64.sqrt(), 5.0)] {
                let velocity = first.lerp(last, s) + 6.0 * s * (1.0 - s) * bulge;
                let force = amplitude * (rate * (before.time + s * passed)).sin();
                change.shaking += weight / 18.0 * passed * self.mass * force.dot(velocity);
            }
        }
        change
    }

    /// The energy in J of a particle of the frame before.
    fn energy(&self, before: &Before, k: usize) -> f64 {
        let (x, v) = (vector(before.positions[k]), vector(before.velocities[k]));
        let energy = self.mass * (0.5 * v.length_squared() + self.lowest - self.gravity.dot(x));
        if energy.is_finite() { energy + before.elastic[k] } else { 0.0 }
    }

    /// The energy in J that the nearest nozzle gave to a particle.
    fn emitted(&self, particles: &Particles, i: usize, elastic: &[f64]) -> f64 {
        let x = vector(particles.positions[i]);
        let distance = |source: &&Source| source.position.distance_squared(x);
        let nearest = self.sources.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
        let Some(Source { position, speed }) = nearest else { return 0.0 };
        let pressure = particles.pressures.get(i).map_or(0.0, |&p| f64::from(p.max(0.0)));
        let volume = self.mass / f64::from(self.params.rest_density);
        let own = self.mass * (0.5 * speed * speed + self.lowest - self.gravity.dot(*position));
        own + elastic.get(i).copied().unwrap_or_default() + pressure * volume
    }
}

/// The change of the balance between two frames, in J.
#[derive(Default)]
struct Change {
    shaking: f64,
    emitted: f64,
    removed: f64,
}

/// The energy per mass in m^2/s^2 that surface tension and the adhesion of bodies can release to a particle.
pub(super) fn attraction_energy(scene: &Scene) -> f64 {
    tension_energy(scene) + adhesion_energy(scene)
}

/// That of the surface of a drop of two spacings, per mass in m^2/s^2.
fn tension_energy(scene: &Scene) -> f64 {
    let (spacing, material) = (scene.fluid.particle_spacing, &scene.fluid.material);
    match scene.solver.surface_tension {
        SurfaceTension::None => 0.0,
        _ => f64::from(2.0 * material.surface_tension / (material.rest_density * spacing)),
    }
}

/// That of a fall through the range of the adhesion of bodies, per mass in m^2/s^2.
fn adhesion_energy(scene: &Scene) -> f64 {
    let adhesion = scene.bodies.iter().map(|body| body.adhesion).fold(0.0, f32::max);
    f64::from(adhesion * scene.solver.support_radius(scene.fluid.particle_spacing))
}

fn remember(time: f64, particles: &Particles, elastic: Vec<f64>, bodies: f64) -> Before {
    let Particles { ids, positions, velocities, .. } = particles;
    Before {
        time,
        ids: ids.clone(),
        positions: positions.clone(),
        velocities: velocities.clone(),
        elastic,
        bodies,
    }
}

fn vector(x: [f32; 3]) -> DVec3 {
    DVec3::from(x.map(f64::from))
}
