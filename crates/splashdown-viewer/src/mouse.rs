//! The mouse force: its size and strength in a scene.

use glam::Vec3;
use splashdown::MouseForce;
use splashdown::scene::Scene;

/// Rate at which the water approaches the velocity of the mouse, in 1/s.
const RATE: f32 = 14.0;
/// Radius over the smallest edge of the domain.
const SIZE: f32 = 0.16;

/// The radius around the ray through the mouse within which water is dragged, in m.
pub fn radius(scene: &Scene) -> f32 {
    (SIZE * scene.domain.size().min_element()).max(3.0 * scene.fluid.particle_spacing)
}

/// The force of a mouse on this ray (a point in m and a unit vector) with this velocity in m/s.
pub fn force(scene: &Scene, ray: (Vec3, Vec3), velocity: Vec3) -> MouseForce {
    // The velocity is limited, because a faster motion would scatter the particles.
    let velocity = velocity.clamp_length_max(3.0 * scene.domain.size().max_element());
    MouseForce::new(ray.0, ray.1, velocity, radius(scene), RATE)
}
