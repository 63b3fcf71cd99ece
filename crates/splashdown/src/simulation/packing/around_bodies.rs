//! Packs blocks around bodies, between their own faces.
//!
//! The particles of a lattice that are outside a body have the volume of the fluid there, but some lie at its surface and
//! others up to a spacing away. If those at the surface were left out, the fluid would start with gaps around bodies and
//! fall into them. Here they move until their density is uniform: the faces of the block are closed, so that free surfaces keep their
//! places, and a background pressure drives particles into gaps, as in the packing of Colagrossi et al. (2012).
//!
//! Only a box around the bodies takes part. Its sides are planes between layers of the lattice, in which the lattice is its
//! own mirror image.

use glam::Vec3;

use super::relaxation::{Brake, Relaxation};
use crate::SimulationError;
use crate::bodies::LoadedBody;
use crate::sample;
use crate::scene::Scene;
use crate::scene::lattice::Sampler;

/// Distance from bodies to which particles move, in spacings.
const REACH: f32 = 6.0;
/// Background pressure over rho0 c^2.
const BACKGROUND: f32 = 0.1;
/// Where no particle is closer to a body than this, in spacings, the lattice fits the bodies and remains as it is, because the
/// packing would disorder it.
const FITTING: f32 = 0.45;
/// Maximum number of rounds.
const MAX_ROUNDS: u32 = 40;
/// Rounds without progress after which the packing ends.
const PATIENCE: u32 = 10;

/// Packs the particles of the blocks that bodies cut; returns the number of rounds.
pub(super) fn pack(
    scene: &Scene,
    positions: &mut [[f32; 3]],
    bodies: &[LoadedBody],
    progress: &dyn Fn(f32),
) -> Result<u32, SimulationError> {
    let fitting = FITTING * scene.fluid.particle_spacing;
    let fits = || sample::far_from(bodies, positions, fitting).iter().all(|is_far| *is_far);
    if !sample::is_packed_around_bodies(scene) || fits() {
        return Ok(0);
    }
    let reach = REACH * scene.fluid.particle_spacing;
    let near: Vec<(Vec3, Vec3)> = bodies.iter().map(|body| bounds(body, reach)).collect();
    let samplers = Sampler::all(&scene.domain, &scene.fluid);
    let mut rounds = 0;
    for (index, sampler) in samplers.iter().enumerate() {
        let Some((low, high)) = sampler.part_within(&near) else { continue };
        let part = |now: f32| progress((index as f32 + now) / samplers.len() as f32);
        rounds += pack_box(scene, positions, bodies, (low, high), &part)?;
    }
    Ok(rounds)
}

/// The corners of the box around a body, extended by `reach` (m).
fn bounds(body: &LoadedBody, reach: f32) -> (Vec3, Vec3) {
    let (position, rotation) = body.pose();
    let empty = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    let (low, high) = body.solid.mesh.vertices.iter().fold(empty, |(low, high), vertex| {
        let x = position + rotation * Vec3::from(*vertex);
        (low.min(x), high.max(x))
    });
    (low - reach, high + reach)
}

/// Packs the particles inside a box.
fn pack_box(
    scene: &Scene,
    positions: &mut [[f32; 3]],
    bodies: &[LoadedBody],
    (low, high): (Vec3, Vec3),
    progress: &dyn Fn(f32),
) -> Result<u32, SimulationError> {
    let is_inside = |x: &[f32; 3]| {
        let x = Vec3::from(*x);
        x.cmpge(low).all() && x.cmple(high).all()
    };
    let chosen: Vec<usize> = (0..positions.len()).filter(|&i| is_inside(&positions[i])).collect();
    if chosen.is_empty() {
        return Ok(0);
    }
    let first: Vec<[f32; 3]> = chosen.iter().map(|&i| positions[i]).collect();
    let mut closed = scene.clone();
    (closed.domain.min, closed.domain.max, closed.domain.closed) = (low, high, [[true; 2]; 3]);
    let mut relaxation = Relaxation::new(&closed, &first, bodies)?;
    let mut least = largest_error(&relaxation.simulation.particles()?.densities);
    relaxation.set_background_pressure(BACKGROUND)?;
    let (mut brake, mut rounds, mut since) = (Brake::default(), 0, 0);
    while rounds < MAX_ROUNDS && since < PATIENCE {
        rounds += 1;
        since += 1;
        let Some(particles) = relaxation.round(first.len())? else { break };
        brake.apply(&mut relaxation, &particles)?;
        let now = largest_error(&particles.densities);
        if now < least {
            if now < 0.98 * least {
                since = 0;
            }
            least = now;
            for (&i, x) in chosen.iter().zip(&particles.positions) {
                positions[i] = *x;
            }
        }
        progress(rounds as f32 / MAX_ROUNDS as f32);
    }
    Ok(rounds)
}

/// The largest difference of a density from the mean, over the mean.
fn largest_error(densities: &[f32]) -> f64 {
    let mean =
        densities.iter().map(|&density| f64::from(density)).sum::<f64>() / densities.len().max(1) as f64;
    densities.iter().map(|&density| (f64::from(density) / mean - 1.0).abs()).fold(0.0, f64::max)
}
