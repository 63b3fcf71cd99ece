//! Settles packed fluid with the implicit pressure of the run.
//!
//! The packing sums densities over the particles that exist. The implicit pressure also completes them at free surfaces and
//! bodies, and removes what is too dense within one step: the fluid would start with the velocity of this displacement,
//! which nothing stops without gravity. Steps without velocity and gravity make the displacement before the start.

use glam::Vec3;

use super::relaxation::Relaxation;
use crate::SimulationError;
use crate::bodies::LoadedBody;
use crate::scene::{Method, Scene};

/// Maximum number of steps.
const MOST_STEPS: u32 = 30;
/// The displacement of a step, in spacings, at which the fluid is settled.
const STILL: f32 = 5e-4;

/// Moves the particles to where the implicit pressure does not move them; returns the number of steps.
pub(super) fn settle(
    scene: &Scene,
    positions: &mut Vec<[f32; 3]>,
    bodies: &[LoadedBody],
) -> Result<u32, SimulationError> {
    if scene.solver.method != Method::Dfsph {
        return Ok(0);
    }
    let mut relaxation = Relaxation::with_implicit_pressure(scene, positions, bodies)?;
    for step in 1..=MOST_STEPS {
        let Some(particles) = relaxation.step(positions.len())? else { return Ok(step) };
        let moved = |(a, b): (&[f32; 3], &[f32; 3])| Vec3::from(*a).distance(Vec3::from(*b));
        let most = positions.iter().zip(&particles.positions).map(moved).fold(0.0, f32::max);
        *positions = particles.positions;
        if most < STILL * scene.fluid.particle_spacing {
            return Ok(step);
        }
        relaxation.stop()?;
    }
    Ok(MOST_STEPS)
}
