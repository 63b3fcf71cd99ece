//! The initial packing: measures the density of the particles at the start and relaxes them where they are too close.
//!
//! *How it works.* Pieces of fluid that do not share a lattice, imported particles and bodies between the points of a
//! lattice leave particles closer than at rest. A summed density then starts with a pressure that bursts. Before the
//! first step the particles therefore move apart under their own pressure, without gravity and velocity, as in the
//! packing of Colagrossi, Bouscasse, Antuono & Marrone (2012), with the passes of the simulation itself. Kinetic energy is
//! removed at each of its maxima (dynamic relaxation, Otter 1966). Only pressure above zero acts, so that free surfaces
//! stay free. The fluid keeps its number of particles: fluid that is too dense grows.
//!
//! *Bodies in blocks.* Blocks are first [packed around bodies](around_bodies), which also closes gaps.
//!
//! *Where the density is integrated*, a body exerts no pressure at the start, however close the particles are, and the
//! fluid may start at its surface. Only particles farther than the support radius from bodies count there.

mod around_bodies;
mod relaxation;
mod settling;

use glam::Vec3;
use serde::Serialize;
use splashdown_io::Particles;
use web_time::Instant;

use crate::bodies::LoadedBody;
use crate::scene::Scene;
use crate::{SimulationError, sample};
use relaxation::Relaxation;

/// The largest density error that is left as it is, over the rest density.
pub(crate) const TOLERANCE: f32 = 0.02;
/// The part of it for fluid that was packed around bodies, because the weight of the fluid moves the layers of a summed
/// density closer together afterwards.
const PACKED: f32 = 0.75;
/// The tolerance for fluid without weight. It expands from a denser packing, and nothing stops it afterwards.
const WEIGHTLESS_TOLERANCE: f32 = 0.1 * TOLERANCE;
/// Fluid that starts with a smaller largest excess than this comes to rest.
const MINOR: f32 = 0.05;
/// Fluid whose mean density is this many times that at rest is refused: it would fill at least twice the space.
const OVERFULL: f32 = 2.0;
/// Mean number of particles in the same cube of one spacing above which the density is not even summed: a sum over all
/// pairs of a million particles in one place would take hours.
const CROWDED: f32 = 16.0;
/// The name of the task for reports of progress.
const TASK: &str = "initial packing";
/// Maximum number of rounds.
pub(super) const MAX_ROUNDS: u32 = 200;

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

    /// What to do about fluid that is not [sound](Self::is_sound).
    pub fn advice(&self) -> &'static str {
        if self.density().excess < MINOR {
            "it moves a little until it rests"
        } else {
            "the fluid does not fit: move its pieces and the bodies apart, or check fluid.particle_spacing"
        }
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

/// Measures the particles of a scene, and relaxes them if they are too dense. `None` for a scene whose fluid is one lattice
/// without bodies and emitters, or empty.
///
/// # Errors
/// [`sample::SampleError::Overfull`] for fluid that is on average more than twice as dense as at rest.
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
    let crowding = sample::crowding(&particles.positions, scene.fluid.particle_spacing);
    if crowding > CROWDED {
        return Err(sample::SampleError::Overfull { ratio: crowding }.into());
    }
    let first = particles.positions.clone();
    let mut relaxation = Relaxation::new(scene, &first, bodies)?;
    let before = relaxation.density(&first)?;
    let ratio = before.mean * (1.0 + before.excess) / before.max;
    if ratio > OVERFULL {
        return Err(sample::SampleError::Overfull { ratio }.into());
    }
    let mut packing = Packing { before, after: None, rounds: 0, moved: 0.0, seconds: 0.0 };
    if most_rounds > 0 {
        let half = |part: f32| progress(TASK, 0.5 * part);
        packing.rounds = around_bodies::pack(scene, &mut particles.positions, bodies, &half)?;
    }
    let (mut density, packed) = (before, packing.rounds > 0);
    if packed {
        relaxation = Relaxation::new(scene, &particles.positions, bodies)?;
        density = relaxation.density(&particles.positions)?;
    }
    let is_weightless = scene.gravity == Vec3::ZERO && scene.domain.oscillation.is_none();
    let tolerance = if is_weightless { WEIGHTLESS_TOLERANCE } else { TOLERANCE };
    let limit = if packed { PACKED * tolerance } else { tolerance };
    if density.excess > limit && most_rounds > 0 {
        let positions = std::mem::take(&mut particles.positions);
        let rest = |part: f32| progress(TASK, if packed { 0.5 + 0.5 * part } else { part });
        (particles.positions, density) =
            relaxation.run(positions, density, tolerance, most_rounds, &mut packing.rounds, &rest)?;
    }
    if packing.rounds > 0 {
        let steps = settling::settle(scene, &mut particles.positions, bodies)?;
        if steps > 0 {
            density = Relaxation::new(scene, &particles.positions, bodies)?.density(&particles.positions)?;
        }
        let moved = |(a, b): (&[f32; 3], &[f32; 3])| Vec3::from(*a).distance(Vec3::from(*b));
        packing.moved = first.iter().zip(&particles.positions).map(moved).fold(0.0, f32::max);
        packing.after = Some(density);
        progress(TASK, 1.0);
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

#[cfg(test)]
mod tests {
    use super::*;

    fn packing(mean: f32, max: f32) -> Packing {
        let before = InitialDensity { mean, max, place: [0.0; 3], excess: max / 1000.0 - 1.0 };
        Packing { before, after: None, rounds: 0, moved: 0.0, seconds: 0.0 }
    }

    #[test]
    fn a_small_excess_is_no_reason_to_move_pieces() {
        assert!(packing(990.0, 1030.0).advice().contains("until it rests"));
        assert!(packing(990.0, 1100.0).advice().contains("does not fit"));
    }
}
