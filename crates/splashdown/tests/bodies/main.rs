//! Bodies and fluid: agreement of both executors and of all boundary kinds, buoyancy, no leaks.

mod contacts;
mod devices;
mod floating;
mod many;
mod motion;
mod resting;
mod shared;
mod still;
mod walls;

use glam::{Quat, Vec3};
use splashdown::scene::{
    Body, BoundaryKind, MeshShape, MeshSource, Motion, Scene, Shape, SolidContact, UpAxis,
};

/// A tank of water.
fn tank(spacing: f32, size: [f32; 3], depth: f32) -> Scene {
    let [x, y, z] = size;
    let text = format!(
        "[scene]\nname = \"tank\"\nduration = 1.0\n[domain]\nmin = [0, 0, 0]\nmax = [{x}, {y}, {z}]\n[fluid]\nparticle_spacing = {spacing}\n\
         [[fluid.block]]\nposition = [0, 0, 0]\nsize = [{x}, {depth}, {z}]\n"
    );
    Scene::parse(&text, "tank").unwrap_or_else(|errors| panic!("{errors}"))
}

/// Leaves a small block of fluid in a corner, far from the bodies: a scene needs some fluid.
fn dry(scene: &mut Scene) {
    if let Shape::Box { min, size } = &mut scene.fluid.blocks[0].shape {
        (*min, *size) = (Vec3::ZERO, Vec3::splat(0.05));
    }
}

/// A model at a place.
fn body(name: &str, model: &str, scale: f32, position: Vec3, motion: Motion) -> Body {
    Body {
        name: name.into(),
        mesh: MeshSource {
            shape: MeshShape::Model(model.into()),
            scale: Vec3::splat(scale),
            up: UpAxis::Y,
            position,
            rotation: Quat::IDENTITY,
        },
        motion,
        friction: 0.0,
        adhesion: 0.0,
        contact: SolidContact::default(),
        boundary: BoundaryKind::Map,
        half_thickness: None,
        shell: None,
        colour: None,
    }
}

/// A free body at rest.
fn free(density: f32) -> Motion {
    Motion::Dynamic { density, velocity: Vec3::ZERO, angular_velocity: Vec3::ZERO, hinge: None }
}
