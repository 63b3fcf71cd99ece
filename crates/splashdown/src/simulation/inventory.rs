//! Counts the particles of a scene without simulating it.

use super::packing::{self, MAX_ROUNDS};
use super::{Packing, Simulation};
use crate::SimulationError;
use crate::check::Built;
use crate::sample::{self, Inventory, SampleError};
use crate::scene::{Scene, lattice};

/// Counts the particles that a [`Simulation`] of this scene starts with. Bodies are loaded for this, which may take
/// seconds the first time; `progress` is called as that of [`Simulation::prepare`].
///
/// # Errors
/// [`SimulationError`] of sampling, bodies and outlets.
pub fn inventory(scene: &Scene, progress: &(dyn Fn(&str, f32) + Sync)) -> Result<Inventory, SimulationError> {
    let built = Built::of(scene);
    let emitted = built.emitted(scene)?.0;
    let blocks = lattice::count(&scene.domain, &scene.fluid);
    if scene.bodies.is_empty() || blocks > sample::MAX_PARTICLES {
        return Ok(Inventory { particles: built.count(scene), removed: 0, emitted });
    }
    let mut particles = built.take_particles(scene)?;
    let removed = sample::remove_inside(scene, &mut particles, &Simulation::load_bodies(scene, progress)?);
    if removed > 0 && particles.is_empty() && emitted == 0 {
        return Err(SampleError::AllInside { removed }.into());
    }
    Ok(Inventory { particles: particles.len() as u64, removed: u64::from(removed), emitted })
}

/// The largest number of particles that [`initial_packing`] relaxes.
const MOST_RELAXED: usize = 500_000;

/// The packing with which a [`Simulation`] of this scene starts. More than half a million particles are measured, but not
/// relaxed. `None` for a scene whose fluid is one lattice without bodies. `progress` is called as that of
/// [`Simulation::prepare`].
///
/// # Errors
/// As [`inventory`].
pub fn initial_packing(
    scene: &Scene,
    progress: &(dyn Fn(&str, f32) + Sync),
) -> Result<Option<Packing>, SimulationError> {
    let built = Built::of(scene);
    if built.count(scene) == 0 || packing::is_lattice(scene) {
        return Ok(None);
    }
    let mut particles = built.take_particles(scene)?;
    let bodies = Simulation::load_bodies(scene, progress)?;
    let is_relaxed = particles.len() <= MOST_RELAXED;
    if is_relaxed {
        sample::remove_inside(scene, &mut particles, &bodies);
    } else {
        // Particles at the surfaces of bodies would be reported although the packing moves them away.
        let bodies: Vec<_> = bodies.iter().collect();
        sample::retain_outside(scene, &mut particles, &bodies, sample::clearance_of(scene));
    }
    built.flow(scene)?.fill_nozzles(&mut particles, scene);
    let rounds = if is_relaxed { MAX_ROUNDS } else { 0 };
    packing::relax(scene, &mut particles, &bodies, rounds, progress)
}
