//! Meshes and initial states shared by the cases.

use std::path::{Path, PathBuf};

use glam::{Quat, Vec3};
use splashdown::Simulation;
use splashdown::scene::{Body, BoundaryKind, MeshShape, MeshSource, Motion, Scene, SolidContact, UpAxis};
use splashdown_io::Mesh;

use super::executor;

/// A body with the mesh of a file or a model, at a position.
pub fn body(name: &str, shape: MeshShape, scale: f32, position: Vec3, motion: Motion) -> Body {
    Body {
        name: name.into(),
        mesh: MeshSource {
            shape,
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

/// Writes a mesh for a scene to read.
pub fn file(folder: &Path, name: &str, mesh: &Mesh) -> MeshShape {
    assert!(mesh.topology().unwrap().is_watertight(), "{name}");
    let path: PathBuf = folder.join(name);
    splashdown_io::write_mesh(&path, mesh).unwrap();
    MeshShape::File(path)
}

/// The fluid of a scene with the densities of water at rest, where the level is `height(x)` in m above each particle.
pub fn at_rest(scene: &Scene, height: impl Fn(Vec3) -> f32) -> Simulation {
    let mut simulation = Simulation::with_executor(scene, executor()).unwrap();
    let mut particles = simulation.particles().unwrap();
    let params = *simulation.params();
    let per_depth = scene.gravity.length() / params.sound_speed.powi(2);
    let density = |x: &[f32; 3]| params.rest_density * (1.0 + per_depth * height(Vec3::from(*x)).max(0.0));
    particles.densities = particles.positions.iter().map(density).collect();
    Simulation::with_particles(scene, executor(), &particles).unwrap()
}
