//! Motion while the shutter is open: the liquid moves by the velocities of its vertices, and bodies by their own.

use std::path::Path;
use std::sync::Arc;

use splashdown::BodyState;
use splashdown::foam::DiffuseParticles;
use splashdown::glam::{Quat, Vec3};
use splashdown::scene::Scene;
use splashdown::surface::{SurfaceParams, Walls, interpolate};
use splashdown_io::{Mesh, Particles, read_particles};
use splashdown_render::Domain;

use super::FrameData;
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
    moved_points(&mesh.vertices, &mesh.velocities, domain, time)
}

/// Points after a time in s. A point inside the domain remains there; without velocities all points rest.
fn moved_points(points: &[[f32; 3]], velocities: &[[f32; 3]], domain: &Domain, time: f32) -> Vec<[f32; 3]> {
    if velocities.len() != points.len() {
        return points.to_vec();
    }
    let (low, high) = (Vec3::from(domain.min), Vec3::from(domain.max));
    let all = points.iter().zip(velocities);
    all.map(|(&point, &velocity)| {
        let point = Vec3::from(point);
        let place = point + time * Vec3::from(velocity);
        place.clamp(low.min(point), high.max(point)).into()
    })
    .collect()
}

/// A frame after a time in s, which may be negative: liquid, droplets and foam have moved by their velocities, and the bodies
/// have these states.
pub(super) fn advanced(data: &FrameData, offset: f64, bodies: Arc<[BodyState]>, scene: &Scene) -> FrameData {
    let domain = appearance::domain(scene);
    let step = offset as f32;
    let moved_particles = |particles: &Particles| {
        let mut moved = particles.clone();
        moved.positions = moved_points(&particles.positions, &particles.velocities, &domain, step);
        Arc::new(moved)
    };
    let moved_mesh = |mesh: &Arc<Mesh>| {
        let mut after = Mesh::clone(mesh);
        after.vertices = moved_points(&mesh.vertices, &mesh.velocities, &domain, step);
        Arc::new(after)
    };
    let moved_foam = |foam: &Arc<DiffuseParticles>| {
        let mut after = DiffuseParticles::clone(foam);
        after.positions = moved_points(&foam.positions, &foam.velocities, &domain, step);
        Arc::new(after)
    };
    FrameData {
        index: data.index,
        time: data.time + offset,
        // Pictures of the surface do not show the particles.
        particles: if data.mesh.is_some() { Arc::default() } else { moved_particles(&data.particles) },
        mesh: data.mesh.as_ref().map(moved_mesh),
        droplets: data.droplets.as_deref().map(moved_particles),
        foam: data.foam.as_ref().map(moved_foam),
        bodies,
    }
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
    match particles_beside(path).filter(|_| mesh.velocities.is_empty()) {
        Some(file) => with_velocities_of(mesh, &read_particles(&file)?, scene),
        None => Ok(mesh),
    }
}

/// As [`with_velocities`], from the particles themselves.
///
/// # Errors
/// [`RunError::Simulation`] if the particles are too far apart.
pub(super) fn with_velocities_of(mesh: Mesh, particles: &Particles, scene: &Scene) -> Result<Mesh, RunError> {
    if !mesh.velocities.is_empty() || particles.velocities.len() != particles.positions.len() {
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
    fn an_advanced_frame_shows_a_later_moment() {
        let text = "[scene]\nname = \"cube\"\nduration = 1\n[domain]\nmin = [0, 0, 0]\nmax = [1, 1, 1]\n[fluid]\n\
            particle_spacing = 0.1\n[[fluid.block]]\nposition = [0, 0, 0]\nsize = [0.5, 0.5, 0.5]\n";
        let scene = Scene::parse(text, "cube").unwrap_or_else(|errors| panic!("{errors}"));
        let mut drops = Particles::from_positions(vec![[0.5, 0.9, 0.5]]);
        drops.velocities = vec![[0.0, 2.0, 0.0]];
        let mut data = FrameData {
            index: 3,
            time: 0.06,
            particles: Arc::default(),
            mesh: Some(Arc::new(mesh([1.0, 0.5, 0.0]))),
            droplets: Some(Arc::new(drops)),
            foam: None,
            bodies: Arc::from([]),
        };
        let bodies: Arc<[BodyState]> = Arc::from([BodyState::at(Vec3::X, Quat::IDENTITY)]);
        let vertex =
            |frame: &FrameData| frame.mesh.as_ref().map_or(Vec3::NAN, |mesh| mesh.vertices[0].into());
        let is_near = |place: Vec3, expected: [f32; 3]| place.distance(expected.into()) < 1e-6;
        let later = advanced(&data, 0.01, Arc::clone(&bodies), &scene);
        assert_eq!((later.bodies.len(), later.index), (1, 3));
        assert!((later.time - 0.07).abs() < 1e-12);
        assert!(is_near(vertex(&later), [0.01, 0.505, 0.5]), "{later:?}");
        let drop = later.droplets.as_ref().map_or(Vec3::NAN, |drops| drops.positions[0].into());
        assert!(is_near(drop, [0.5, 0.92, 0.5]), "{drop}");
        // Backwards as well, and not out of the domain.
        let earlier = advanced(&data, -0.01, Arc::clone(&bodies), &scene);
        assert!(is_near(vertex(&earlier), [0.0, 0.495, 0.5]), "{earlier:?}");
        // Control: without velocities the liquid rests.
        data.mesh = Some(Arc::new(Mesh::new(vec![[0.5; 3]], vec![])));
        assert!(is_near(vertex(&advanced(&data, 0.01, bodies, &scene)), [0.5; 3]));
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
