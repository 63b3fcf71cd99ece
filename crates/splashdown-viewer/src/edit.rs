//! Adding bodies and emitters to a scene.

#[cfg(not(target_arch = "wasm32"))]
use std::path::PathBuf;

use glam::{Quat, Vec3};
#[cfg(not(target_arch = "wasm32"))]
use splashdown::scene::FluidMesh;
use splashdown::scene::{
    Body, BoundaryKind, Emitter, MeshShape, MeshSource, Motion, Outlet, Scene, SolidContact, UpAxis,
};

/// Density of added bodies over the fluid's.
const DENSITY_RATIO: f32 = 0.5;
/// Size of added bodies over the smallest edge of the domain.
const SIZE: f32 = 0.2;
/// The minimum duration for which a tap has particles, in s.
const TAP_TIME: f32 = 60.0;
/// The minimum speed of a tap, in heights of the domain per second. It applies where gravity is weak.
const TAP_MIN_SPEED: f32 = 0.1;
/// The tap's name.
const TAP: &str = "tap";

/// Adds a floating ball that falls from the top of the domain.
pub fn add_ball(scene: &mut Scene) {
    // The model's diameter is 0.2 m.
    let scale = added_size(scene) / 0.2;
    let shape = MeshShape::Model("sphere".to_owned());
    let colours = [[0.8, 0.25, 0.15], [0.9, 0.6, 0.1], [0.2, 0.5, 0.25], [0.55, 0.3, 0.6]];
    let colour = colours[scene.bodies.len() % colours.len()];
    add_body(scene, "ball", shape, scale, Vec3::ZERO, Some(colour));
}

/// Adds a mesh from a file with this bounding box, in the file's units; it is scaled to fit and floats.
#[cfg(not(target_arch = "wasm32"))]
pub fn add_mesh(scene: &mut Scene, file: PathBuf, bounds: [Vec3; 2]) {
    let name = file.file_stem().map_or_else(|| "mesh".to_owned(), |stem| stem.to_string_lossy().into_owned());
    let name: String = name
        .chars()
        .map(|c| if c.is_ascii_alphanumeric() || c == '-' || c == '_' { c } else { '-' })
        .collect();
    let (scale, middle) = fitted(scene, bounds);
    add_body(scene, &name, MeshShape::File(file), scale, middle, None);
}

/// Fills a closed mesh with fluid, from a file with this bounding box, in the file's units. It is scaled to fit into the
/// upper middle of the domain.
#[cfg(not(target_arch = "wasm32"))]
pub fn add_fluid_mesh(scene: &mut Scene, file: PathBuf, bounds: [Vec3; 2]) {
    let (scale, middle) = fitted(scene, bounds);
    let position = scene.domain.min + Vec3::new(0.5, 0.6, 0.5) * scene.domain.size() - middle;
    let shape = MeshShape::File(file);
    let mesh =
        MeshSource { shape, scale: Vec3::splat(scale), up: UpAxis::Y, position, rotation: Quat::IDENTITY };
    scene.fluid.meshes.push(FluidMesh::new(mesh));
}

/// The scale that fits a mesh with this bounding box into the domain, and the middle of the scaled mesh.
#[cfg(not(target_arch = "wasm32"))]
fn fitted(scene: &Scene, [low, high]: [Vec3; 2]) -> (f32, Vec3) {
    let size = (high - low).max_element();
    let scale = if size > 0.0 && size.is_finite() { 1.5 * added_size(scene) / size } else { 1.0 };
    (scale, scale * 0.5 * (low + high))
}

/// Opens or closes a tap over the middle of the domain; returns whether it is open now.
pub fn turn_tap(scene: &mut Scene) -> bool {
    if let Some(index) = scene.emitters.iter().position(|emitter| emitter.name == TAP) {
        scene.emitters.remove(index);
        return false;
    }
    let (size, spacing) = (scene.domain.size(), scene.fluid.particle_spacing);
    let radius = (0.08 * size.min_element()).max(2.5 * spacing);
    let top = scene.domain.max.y - 3.0 * spacing;
    let center = scene.domain.center();
    // The speed after a fall through an eighth of the height.
    let speed = (0.25 * size.y * scene.gravity.length()).sqrt();
    // Particles are allocated in advance for the duration of the scene.
    scene.duration = scene.duration.max(TAP_TIME);
    let max_particles = (2 * splashdown::check::count(scene)).clamp(20_000, 500_000) as u32;
    scene.emitters.push(Emitter {
        name: TAP.to_owned(),
        outlet: Outlet::Disc { radius },
        position: Vec3::new(center.x, top, center.z),
        direction: Vec3::NEG_Y,
        speed: speed.max(TAP_MIN_SPEED * size.y),
        start: 0.0,
        end: None,
        max_particles: Some(max_particles),
    });
    true
}

/// Whether a tap is open.
pub fn has_tap(scene: &Scene) -> bool {
    scene.emitters.iter().any(|emitter| emitter.name == TAP)
}

fn added_size(scene: &Scene) -> f32 {
    (SIZE * scene.domain.size().min_element()).max(5.0 * scene.fluid.particle_spacing)
}

/// Adds a dynamic body. `middle` is the middle of the scaled mesh, relative to its origin.
fn add_body(
    scene: &mut Scene,
    name: &str,
    shape: MeshShape,
    scale: f32,
    middle: Vec3,
    colour: Option<[f32; 3]>,
) {
    let same_name = scene.bodies.iter().filter(|body| body.name.starts_with(name)).count();
    let mut number = same_name + 1;
    while scene.bodies.iter().any(|body| body.name == format!("{name}-{number}")) {
        number += 1;
    }
    let (low, size) = (scene.domain.min, scene.domain.size());
    // Successive bodies are placed at multiples of the golden angle, so that they do not collide.
    let angle = 2.399_963 * number as f32;
    let offset = Vec3::new(0.2 * size.x * angle.cos(), 0.0, 0.2 * size.z * angle.sin());
    let position = low + Vec3::new(0.5, 0.8, 0.5) * size + offset;
    scene.bodies.push(Body {
        name: format!("{name}-{number}"),
        mesh: MeshSource {
            shape,
            scale: Vec3::splat(scale),
            up: UpAxis::Y,
            position: position - middle,
            rotation: Quat::IDENTITY,
        },
        motion: Motion::Dynamic {
            density: DENSITY_RATIO * scene.fluid.material.rest_density,
            velocity: Vec3::ZERO,
            angular_velocity: Vec3::ZERO,
            hinge: None,
        },
        friction: 0.2,
        adhesion: 0.0,
        contact: SolidContact::default(),
        boundary: BoundaryKind::Map,
        half_thickness: None,
        shell: None,
        colour,
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use splashdown::scene::presets;
    use splashdown::{Device, Simulation};

    #[test]
    fn added_bodies_are_valid_and_separate() {
        let (name, text) = presets()[1];
        let mut scene = Scene::parse(text, name).unwrap();
        scene.fluid.particle_spacing *= 1.5;
        for _ in 0..3 {
            add_ball(&mut scene);
        }
        assert!(turn_tap(&mut scene));
        let mut simulation = Simulation::new(&scene, &Device::Cpu).unwrap();
        let stats = simulation.advance(0.05).unwrap();
        assert!(stats.emitted > 0, "{stats:?}");
        let positions: Vec<Vec3> =
            simulation.body_states().unwrap().iter().map(|state| state.position).collect();
        assert!(positions[0].distance(positions[1]) > added_size(&scene), "{positions:?}");
        assert!(!turn_tap(&mut scene));
        assert!(scene.emitters.is_empty());
    }

    #[test]
    fn the_speed_of_a_tap_follows_the_gravity_of_the_scene() {
        let (name, text) = presets()[1];
        let speed = |gravity: f32| {
            let mut scene = Scene::parse(text, name).unwrap();
            scene.gravity = Vec3::NEG_Y * gravity;
            assert!(turn_tap(&mut scene) && has_tap(&scene));
            scene.emitters[0].speed
        };
        let height = Scene::parse(text, name).unwrap().domain.size().y;
        for gravity in [9.81, 1.62] {
            let fallen = (2.0 * gravity * height / 8.0).sqrt();
            assert!(
                (speed(gravity) - fallen).abs() < 1e-5 * fallen,
                "{gravity} m/s^2: {} m/s",
                speed(gravity)
            );
        }
        assert!(speed(0.0) > 0.0);
    }
}
