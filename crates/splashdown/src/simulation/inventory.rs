//! Counts the particles of a scene without simulating it.

use super::Simulation;
use crate::SimulationError;
use crate::check::Built;
use crate::sample::{self, Inventory, SampleError};
use crate::scene::{Scene, lattice};

/// Counts the particles that a [`Simulation`] of this scene starts with. Bodies are loaded for this, which may take
/// seconds the first time.
///
/// # Errors
/// [`SimulationError`] of sampling, bodies and outlets.
pub fn inventory(scene: &Scene) -> Result<Inventory, SimulationError> {
    let built = Built::of(scene);
    let emitted = built.emitted(scene)?.0;
    let blocks = lattice::count(&scene.domain, &scene.fluid);
    if scene.bodies.is_empty() || blocks > sample::MAX_PARTICLES {
        return Ok(Inventory { particles: built.count(scene), removed: 0, emitted });
    }
    let mut particles = built.take_particles(scene)?;
    let removed = sample::remove_inside(scene, &mut particles, &Simulation::load_bodies(scene, &|_, _| {})?);
    if removed > 0 && particles.is_empty() && emitted == 0 {
        return Err(SampleError::AllInside { removed }.into());
    }
    Ok(Inventory { particles: particles.len() as u64, removed: u64::from(removed), emitted })
}
