//! Motion while the shutter is open: the liquid moves by the velocities of its vertices, and bodies by their own.

use std::path::Path;

use splashdown::BodyState;
use splashdown::glam::{Quat, Vec3};
use splashdown::scene::Scene;
use splashdown::surface::{SurfaceParams, Walls, interpolate};
use splashdown_io::{Mesh, read_particles};
use splashdown_render::Domain;

use super::droplets::particles_beside;
use crate::{RunError, appearance};

/// The largest number of moments of a picture.
const MOMENTS: u32 = 8;

/// Whether pictures of the scene's surface are blurred by motion, so that their meshes need velocities.
pub(crate) fn is_blurred(scene: &Scene) -> bool {
    appearance::quality(scene, scene.output.quality).is_some_and(|quality| quality.shutter > 0.0)
}

/// Number of moments that the samples of a picture show: one if nothing moves by more than a hundredth of `size`, a length
/// in m.
pub(super) fn moments(mesh: &Mesh, bodies: &[BodyState], shutter: f32, samples: u32, size: f32) -> u32 {
    let is_fast = |velocity: Vec3| velocity.length() * shutter > 0.01 * size;
    let moves = mesh.velocities.iter().any(|&velocity| is_fast(velocity.into()))
        || bodies.iter().any(|body| is_fast(body.velocity) || is_fast(body.angular_velocity * size));
    if moves { MOMENTS.min(samples).max(1) } else { 1 }
}

/// The vertices after a time in s. A vertex inside the domain remains there.
pub(super) fn moved(mesh: &Mesh, domain: &Domain, time: f32) -> Vec<[f32; 3]> {
    let (low, high) = (Vec3::from(domain.min), Vec3::from(domain.max));
    let all = mesh.vertices.iter().zip(&mesh.velocities);
    all.map(|(&vertex, &velocity)| {
        let vertex = Vec3::from(vertex);
        let place = vertex + time * Vec3::from(velocity);
        place.clamp(low.min(vertex), high.max(vertex)).into()
    })
    .collect()
}

/// Position and orientation of a body after a time in s.
pub(super) fn moved_body(state: &BodyState, time: f32) -> ([f32; 3], [f32; 4]) {
    let turn = Quat::from_scaled_axis(time * state.angular_velocity);
    ((state.position + time * state.velocity).to_array(), (turn * state.orientation).to_array())
}

/// The mesh of a frame of a finished run with velocities, from the particles of the frame; as it is if it has velocities, or
/// if there is no file of particles with velocities.
///
/// # Errors
/// [`RunError::Io`] if the file cannot be read; [`RunError::Simulation`] if the particles are too far apart.
pub(super) fn with_velocities(mesh: Mesh, path: &Path, scene: &Scene) -> Result<Mesh, RunError> {
    let Some(file) = particles_beside(path).filter(|_| mesh.velocities.is_empty()) else { return Ok(mesh) };
    let particles = read_particles(&file)?;
    if particles.velocities.len() != particles.positions.len() {
        return Ok(mesh);
    }
    let params = SurfaceParams::of_scene(&scene.surface, scene.fluid.particle_spacing, Walls::NONE);
    let velocities = interpolate(&mesh.vertices, &particles.positions, &particles.velocities, &params)
        .map_err(splashdown::SimulationError::from)?;
    Ok(mesh.with_velocities(velocities))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mesh(velocity: [f32; 3]) -> Mesh {
        let vertices = vec![[0.0, 0.5, 0.5], [0.9, 0.5, 0.5], [1.5, 0.5, 0.5]];
        Mesh::new(vertices, vec![[0, 1, 2]]).with_velocities(vec![velocity; 3])
    }

    #[test]
    fn vertices_move_and_remain_in_the_domain() {
        let domain = Domain::closed([0.0; 3], [1.0; 3]);
        let moved = moved(&mesh([1.0, 0.5, 0.0]), &domain, 0.2);
        for (place, expected) in moved.into_iter().zip([[0.2, 0.6, 0.5], [1.0, 0.6, 0.5], [1.5, 0.6, 0.5]]) {
            assert!(Vec3::from(place).distance(expected.into()) < 1e-6, "{place:?}");
        }
    }

    #[test]
    fn a_body_turns_about_its_origin() {
        let mut state = BodyState::at(Vec3::X, Quat::IDENTITY);
        state.velocity = Vec3::Y;
        state.angular_velocity = Vec3::Z * std::f32::consts::PI;
        let (position, orientation) = moved_body(&state, 0.5);
        assert_eq!(position, [1.0, 0.5, 0.0]);
        let turned = Quat::from_array(orientation) * Vec3::X;
        assert!(turned.distance(Vec3::Y) < 1e-6, "{turned}");
    }

    #[test]
    fn a_picture_at_rest_shows_one_moment() {
        let rest = [BodyState::at(Vec3::ZERO, Quat::IDENTITY)];
        assert_eq!(moments(&mesh([0.001, 0.0, 0.0]), &rest, 0.01, 64, 1.0), 1);
        assert_eq!(moments(&mesh([2.0, 0.0, 0.0]), &rest, 0.01, 64, 1.0), 8);
        assert_eq!(moments(&mesh([2.0, 0.0, 0.0]), &rest, 0.01, 4, 1.0), 4);
        let mut wheel = rest;
        wheel[0].angular_velocity = Vec3::X * 3.0;
        assert_eq!(moments(&mesh([0.0; 3]), &wheel, 0.01, 64, 1.0), 8);
    }
}
