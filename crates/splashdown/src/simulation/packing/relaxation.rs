//! The dynamic relaxation of particles: a simulation without gravity whose kinetic energy is removed at each of its maxima.

use glam::{Vec3, Vec4};
use splashdown_gpu::{CpuExecutor, block_on};
use splashdown_io::Particles;

use super::InitialDensity;
use crate::bodies::{Body, LoadedBody};
use crate::scene::{DensityMode, InitialPressure, Method, NegativePressure, Scene, SurfaceTension};
use crate::schemes::Scheme;
use crate::{Simulation, SimulationError, sample};

/// The density error at which the relaxation ends, over the tolerance.
const TARGET: f32 = 0.5;
/// Rounds without progress after which the relaxation ends.
const PATIENCE: u32 = 40;
/// Steps per round.
const STEPS: f32 = 4.0;

/// An estimate of the completed part of a relaxation in [0, 1]: of the rounds, or of the way from the density error `before`
/// to the target, whichever is farther. Errors fall by a factor per round.
fn completed_part(rounds: u32, most_rounds: u32, [before, now, target]: [f32; 3]) -> f32 {
    let way = (before / now.max(target)).ln() / (before / target).ln();
    way.max(rounds as f32 / most_rounds.max(1) as f32).clamp(0.0, 1.0)
}

/// The fluid of a scene without gravity.
pub(super) struct Relaxation {
    pub simulation: Simulation,
    /// Whether a particle counts, if not all do.
    counts: Option<Vec<bool>>,
}

impl Relaxation {
    pub fn new(
        scene: &Scene,
        positions: &[[f32; 3]],
        bodies: &[LoadedBody],
    ) -> Result<Self, SimulationError> {
        Self::of(scene, explicit(without_motion(scene)), positions, bodies)
    }

    /// As [`new`](Self::new), with the implicit pressure of `dfsph`.
    pub fn with_implicit_pressure(
        scene: &Scene,
        positions: &[[f32; 3]],
        bodies: &[LoadedBody],
    ) -> Result<Self, SimulationError> {
        let mut relaxation = Self::of(scene, without_motion(scene), positions, bodies)?;
        // Without gravity a full domain would be soft, and keep an excess that the run removes.
        let Simulation { params, executor, fields, .. } = &mut relaxation.simulation;
        (params.accepted_excess, params.motion_stiffness) = (0.0, 0.0);
        executor.write(fields.params, &[*params])?;
        Ok(relaxation)
    }

    fn of(
        scene: &Scene,
        still: Scene,
        positions: &[[f32; 3]],
        bodies: &[LoadedBody],
    ) -> Result<Self, SimulationError> {
        let still_bodies: Vec<LoadedBody> = bodies.iter().map(LoadedBody::at_rest).collect();
        let particles =
            Particles::from_positions(positions.to_vec()).with_ids((0..positions.len() as u32).collect());
        let executor = CpuExecutor::new().into();
        let carried = Scheme::new(&still).carried();
        let simulation =
            block_on(Simulation::with_bodies(&still, executor, &particles, still_bodies, carried))?;
        let is_integrated =
            scene.solver.method == Method::Wcsph && scene.solver.density == DensityMode::Continuity;
        let counts = (is_integrated && !bodies.is_empty()).then(|| {
            let reach = scene.solver.support_radius(scene.fluid.particle_spacing);
            sample::far_from(bodies, positions, reach)
        });
        Ok(Self { simulation, counts })
    }

    /// The densities of the particles, whose positions are `positions`.
    pub fn density(&mut self, positions: &[[f32; 3]]) -> Result<InitialDensity, SimulationError> {
        let particles = self.simulation.particles()?;
        let rest = self.simulation.params().rest_density;
        let counts = |i: &usize| self.counts.as_ref().is_none_or(|counts| counts[*i]);
        let densities = &particles.densities;
        let sum: f64 = densities.iter().map(|&density| f64::from(density)).sum();
        let densest = (0..densities.len().min(positions.len()))
            .filter(counts)
            .max_by(|&a, &b| densities[a].total_cmp(&densities[b]));
        let (max, place) = densest.map_or((rest, [0.0; 3]), |i| (densities[i], positions[i]));
        Ok(InitialDensity {
            mean: (sum / densities.len().max(1) as f64) as f32,
            max,
            place,
            excess: max / rest - 1.0,
        })
    }

    /// Relaxes the particles to half of the tolerance; returns the best positions and their density.
    pub fn run(
        &mut self,
        first: Vec<[f32; 3]>,
        before: InitialDensity,
        tolerance: f32,
        most_rounds: u32,
        rounds: &mut u32,
        progress: &dyn Fn(f32),
    ) -> Result<(Vec<[f32; 3]>, InitialDensity), SimulationError> {
        let (mut best, mut least) = (first, before);
        let (mut brake, mut since) = (Brake::default(), 0);
        let target = TARGET * tolerance;
        let complete =
            |rounds: u32, excess: f32| completed_part(rounds, most_rounds, [before.excess, excess, target]);
        progress(0.0);
        while *rounds < most_rounds && since < PATIENCE && least.excess > target {
            *rounds += 1;
            let Some(particles) = self.round(best.len())? else { break };
            let density = self.density(&particles.positions)?;
            brake.apply(self, &particles)?;
            since += 1;
            if density.excess < least.excess {
                if density.excess < 0.98 * least.excess {
                    since = 0;
                }
                (best, least) = (particles.positions, density);
            }
            progress(complete(*rounds, least.excess));
        }
        Ok((best, least))
    }

    /// Adds a pressure, given over rho0 c^2, at the rest density.
    pub fn set_background_pressure(&mut self, pressure: f32) -> Result<(), SimulationError> {
        let Simulation { params, executor, fields, .. } = &mut self.simulation;
        params.background_pressure = pressure * params.rest_density * params.sound_speed * params.sound_speed;
        Ok(executor.write(fields.params, &[*params])?)
    }

    /// Takes one step and returns the particles; `None` if there are no longer `expected` ones.
    pub fn step(&mut self, expected: usize) -> Result<Option<Particles>, SimulationError> {
        self.advance(self.simulation.dt(), expected)
    }

    /// Takes the steps of a round and returns the particles; `None` if there are no longer `expected` ones.
    pub fn round(&mut self, expected: usize) -> Result<Option<Particles>, SimulationError> {
        self.advance(STEPS * self.simulation.dt(), expected)
    }

    fn advance(&mut self, seconds: f32, expected: usize) -> Result<Option<Particles>, SimulationError> {
        let stats = self.simulation.advance(seconds)?;
        let particles = self.simulation.particles()?;
        Ok((stats.escaped == 0 && particles.len() == expected).then_some(particles))
    }

    /// Sets all velocities to zero.
    pub fn stop(&mut self) -> Result<(), SimulationError> {
        let velocities = self.simulation.fields.velocities;
        let mut values: Vec<Vec4> = block_on(self.simulation.executor.fetch(velocities))?;
        values.iter_mut().for_each(|v| *v = Vec4::new(0.0, 0.0, 0.0, v.w));
        Ok(self.simulation.executor.write(velocities, &values)?)
    }
}

/// Removes the kinetic energy at each of its maxima.
#[derive(Default)]
pub(super) struct Brake {
    energy: f64,
}

impl Brake {
    /// Stops the particles of a relaxation, as they are after a round, if their energy has fallen.
    pub fn apply(
        &mut self,
        relaxation: &mut Relaxation,
        particles: &Particles,
    ) -> Result<(), SimulationError> {
        let squares = particles.velocities.iter().map(|v| f64::from(Vec3::from(*v).length_squared()));
        let now = squares.sum::<f64>();
        let has_fallen = now < self.energy;
        self.energy = if has_fallen { 0.0 } else { now };
        if has_fallen { relaxation.stop() } else { Ok(()) }
    }
}

/// The scene with a pressure by the density of each particle.
fn explicit(mut still: Scene) -> Scene {
    if still.solver.method == Method::Dfsph {
        still.solver.method = Method::Wcsph;
    }
    still
}

/// The scene at rest: only the pressure of its particles acts.
fn without_motion(scene: &Scene) -> Scene {
    let mut still = scene.clone();
    still.built = Default::default();
    // The speed of sound sets the scale of the time only.
    still.solver.sound_speed = Some(10.0);
    still.solver.stiffness = None;
    still.gravity = Vec3::ZERO;
    still.domain.oscillation = None;
    (still.emitters, still.sinks, still.probes) = (Vec::new(), Vec::new(), Vec::new());
    // The particles are given.
    (still.fluid.meshes, still.fluid.files) = (Vec::new(), Vec::new());
    still.fluid.initial_pressure = InitialPressure::Zero;
    still.fluid.material.viscosity = 1e-6;
    still.solver.density = DensityMode::Summation;
    still.solver.cfl_factor = still.solver.cfl_factor.min(0.3);
    still.solver.negative_pressure = NegativePressure::Clamp;
    still.solver.surface_tension = SurfaceTension::None;
    still.solver.artificial_viscosity = 0.1;
    still.solver.wall_friction = 0.0;
    (still.solver.max_dt, still.solver.min_dt) = (1.0, 1e-9);
    for body in &mut still.bodies {
        body.motion = crate::scene::Motion::Static;
        (body.friction, body.adhesion) = (0.0, 0.0);
    }
    still
}

impl LoadedBody {
    /// The body at its present pose, without motion.
    fn at_rest(&self) -> Self {
        let mut still = self.clone();
        still.state.kind = Body::STATIC;
        (still.state.velocity, still.state.angular_velocity) = (Vec3::ZERO, Vec3::ZERO);
        (still.state.friction, still.state.adhesion) = (0.0, 0.0);
        still.script = None;
        still
    }
}
