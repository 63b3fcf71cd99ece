//! The initial packing: measures the density of the particles at the start and relaxes them where they are too close.
//!
//! *How it works.* Pieces of fluid that do not share a lattice, imported particles and bodies between the points of a
//! lattice leave particles closer than at rest. A summed density then starts with a pressure that bursts. Before the
//! first step the particles therefore move apart under their own pressure, without gravity and velocity, as in the
//! packing of Colagrossi, Bouscasse, Antuono & Marrone (2012), with the passes of the simulation itself. Kinetic energy is
//! removed at each of its maxima (dynamic relaxation, Otter 1966). Only pressure above zero acts, so that free surfaces
//! stay free. The fluid keeps its number of particles: fluid that is too dense grows.
//!
//! *Where the density is integrated*, a body exerts no pressure at the start, however close the particles are, and the
//! fluid may start at its surface. Only particles farther than the support radius from bodies count there.

use glam::{Vec3, Vec4};
use serde::Serialize;
use splashdown_gpu::{CpuExecutor, block_on};
use splashdown_io::Particles;
use web_time::Instant;

use super::Simulation;
use crate::bodies::{Body, LoadedBody};
use crate::scene::{DensityMode, InitialPressure, Method, NegativePressure, Scene, SurfaceTension};
use crate::state::CARRIED;
use crate::{SimulationError, sample};

/// The largest density error that is left as it is, over the rest density.
pub(crate) const TOLERANCE: f32 = 0.02;
/// The density error at which the relaxation ends, over the rest density.
const TARGET: f32 = 0.5 * TOLERANCE;
/// The name of the task for reports of progress.
const TASK: &str = "initial packing";
/// Maximum number of rounds.
pub(super) const MAX_ROUNDS: u32 = 200;
/// Rounds without progress after which the relaxation ends.
const PATIENCE: u32 = 40;
/// Steps per round.
const STEPS: f32 = 4.0;

/// The density of particles at the start, summed over their neighbours, walls and bodies.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct InitialDensity {
    /// Mean in kg/m^3; particles at free surfaces lower it.
    pub mean: f32,
    /// Maximum in kg/m^3.
    pub max: f32,
    /// The place of the maximum in m.
    pub place: [f32; 3],
    /// The maximum over the rest density, minus one.
    pub excess: f32,
}

/// The initial packing of a simulation.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Packing {
    /// The density of the particles as they were placed.
    pub before: InitialDensity,
    /// The density after the relaxation; `None` if nothing was relaxed.
    pub after: Option<InitialDensity>,
    /// Rounds of four steps.
    pub rounds: u32,
    /// The largest displacement in m.
    pub moved: f32,
    /// The time it took, in s.
    pub seconds: f32,
}

impl Packing {
    /// The densities with which the simulation starts.
    pub fn density(&self) -> &InitialDensity {
        self.after.as_ref().unwrap_or(&self.before)
    }

    /// Whether the fluid is at most 2 % too dense.
    pub fn is_sound(&self) -> bool {
        self.density().excess <= TOLERANCE
    }
}

impl std::fmt::Display for Packing {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let percent = |density: &InitialDensity| format!("{:.1} %", 100.0 * density.excess.max(0.0));
        let [x, y, z] = self.before.place;
        let Some(after) = &self.after else {
            return write!(f, "density at most {} above rest", percent(&self.before));
        };
        write!(
            f,
            "particles were up to {} too dense, at ({x:.3}, {y:.3}, {z:.3}) m; relaxed to {} in {} rounds and {:.1} s, moved by at most {:.2e} m",
            percent(&self.before),
            percent(after),
            self.rounds,
            self.seconds,
            self.moved
        )
    }
}

/// Measures the particles of a scene, and relaxes them if they are too dense. `None` for a scene whose fluid is one
/// lattice without bodies and emitters, or empty.
pub(super) fn relax(
    scene: &Scene,
    particles: &mut Particles,
    bodies: &[LoadedBody],
    most_rounds: u32,
    progress: &(dyn Fn(&str, f32) + Sync),
) -> Result<Option<Packing>, SimulationError> {
    if is_lattice(scene) || particles.is_empty() {
        return Ok(None);
    }
    let begun = Instant::now();
    let first = particles.positions.clone();
    let mut relaxation = Relaxation::new(scene, &first, bodies)?;
    let before = relaxation.density(&first)?;
    let mut packing = Packing { before, after: None, rounds: 0, moved: 0.0, seconds: 0.0 };
    if before.excess > TOLERANCE && most_rounds > 0 {
        let (positions, after) =
            relaxation.run(first.clone(), before, most_rounds, &mut packing.rounds, progress)?;
        let moved = |(a, b): (&[f32; 3], &[f32; 3])| Vec3::from(*a).distance(Vec3::from(*b));
        packing.moved = first.iter().zip(&positions).map(moved).fold(0.0, f32::max);
        packing.after = Some(after);
        particles.positions = positions;
    }
    packing.seconds = begun.elapsed().as_secs_f32();
    Ok(Some(packing))
}

/// Whether the fluid of a scene is a single lattice, which no body cuts.
pub(super) fn is_lattice(scene: &Scene) -> bool {
    let fluid = &scene.fluid;
    let is_alone = scene.bodies.is_empty() && scene.emitters.is_empty();
    is_alone && sample::has_blocks_only(fluid) && fluid.blocks.len() < 2
}

/// An estimate of the completed part of a relaxation in [0, 1]: of the rounds, or of the way to the target, whichever is
/// farther. Errors fall by a factor per round.
fn completed_part(rounds: u32, most_rounds: u32, before: f32, now: f32) -> f32 {
    let way = (before / now.max(TARGET)).ln() / (before / TARGET).ln();
    way.max(rounds as f32 / most_rounds.max(1) as f32).clamp(0.0, 1.0)
}

/// The fluid of a scene without gravity.
struct Relaxation {
    simulation: Simulation,
    /// Whether a particle counts, if not all do.
    counts: Option<Vec<bool>>,
}

impl Relaxation {
    fn new(scene: &Scene, positions: &[[f32; 3]], bodies: &[LoadedBody]) -> Result<Self, SimulationError> {
        let still = without_motion(scene);
        let still_bodies: Vec<LoadedBody> = bodies.iter().map(LoadedBody::at_rest).collect();
        let particles =
            Particles::from_positions(positions.to_vec()).with_ids((0..positions.len() as u32).collect());
        let executor = CpuExecutor::new().into();
        let simulation =
            block_on(Simulation::with_bodies(&still, executor, &particles, still_bodies, CARRIED))?;
        let is_integrated =
            scene.solver.method == Method::Wcsph && scene.solver.density == DensityMode::Continuity;
        let counts = (is_integrated && !bodies.is_empty()).then(|| {
            let reach = scene.solver.support_radius(scene.fluid.particle_spacing);
            sample::far_from(bodies, positions, reach)
        });
        Ok(Self { simulation, counts })
    }

    /// The densities of the particles, whose positions are `positions`.
    fn density(&mut self, positions: &[[f32; 3]]) -> Result<InitialDensity, SimulationError> {
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

    /// Relaxes the particles; returns the best positions and their density.
    fn run(
        &mut self,
        first: Vec<[f32; 3]>,
        before: InitialDensity,
        most_rounds: u32,
        rounds: &mut u32,
        progress: &(dyn Fn(&str, f32) + Sync),
    ) -> Result<(Vec<[f32; 3]>, InitialDensity), SimulationError> {
        let (mut best, mut least) = (first, before);
        let (mut energy, mut since) = (0.0_f64, 0);
        let complete = |rounds: u32, excess: f32| completed_part(rounds, most_rounds, before.excess, excess);
        progress(TASK, 0.0);
        while *rounds < most_rounds && since < PATIENCE && least.excess > TARGET {
            *rounds += 1;
            let duration = STEPS * self.simulation.dt();
            let stats = self.simulation.advance(duration)?;
            let particles = self.simulation.particles()?;
            if stats.escaped > 0 || particles.len() != best.len() {
                break;
            }
            let density = self.density(&particles.positions)?;
            since += 1;
            if density.excess < least.excess {
                if density.excess < 0.98 * least.excess {
                    since = 0;
                }
                (best, least) = (particles.positions, density);
            }
            let squares = particles.velocities.iter().map(|v| f64::from(Vec3::from(*v).length_squared()));
            let now = squares.sum::<f64>();
            if now < energy {
                self.stop()?;
                energy = 0.0;
            } else {
                energy = now;
            }
            progress(TASK, complete(*rounds, least.excess));
        }
        progress(TASK, 1.0);
        Ok((best, least))
    }

    /// Sets all velocities to zero.
    fn stop(&mut self) -> Result<(), SimulationError> {
        let velocities = self.simulation.fields.velocities;
        let mut values: Vec<Vec4> = block_on(self.simulation.executor.fetch(velocities))?;
        values.iter_mut().for_each(|v| *v = Vec4::new(0.0, 0.0, 0.0, v.w));
        Ok(self.simulation.executor.write(velocities, &values)?)
    }
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
    if still.solver.method == Method::Dfsph {
        still.solver.method = Method::Wcsph;
    }
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
