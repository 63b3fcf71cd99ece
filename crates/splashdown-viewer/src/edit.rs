//! Adding bodies and emitters to a scene.

#[cfg(not(target_arch = "wasm32"))]
use std::path::PathBuf;

use glam::{Quat, Vec3};
#[cfg(not(target_arch = "wasm32"))]
use splashdown::scene::FluidMesh;
use splashdown::scene::{
    Body, BoundaryKind, Emitter, MeshShape, MeshSource, Motion, Outlet, Scene, SolidContact, UpAxis,
};

use crate::items::{decimal, decimals};

/// Density of added bodies over the fluid's.
const DENSITY_RATIO: f32 = 0.5;
/// Size of added bodies over the smallest edge of the domain.
const SIZE: f32 = 0.2;
/// The minimum duration for which an added emitter has particles, in s.
const EMITTER_TIME: f32 = 60.0;
/// The minimum speed of an added emitter, in heights of the domain per second. It applies where gravity is weak.
const EMITTER_MIN_SPEED: f32 = 0.1;
/// The names of added emitters start with this.
const EMITTER: &str = "emitter-";

/// Adds a floating ball that falls from the top of the domain.
pub fn add_ball(scene: &mut Scene) {
    // The model's diameter is 0.2 m.
    let scale = decimal(added_size(scene) / 0.2, 0.01);
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
    let position = decimals(position, scene.fluid.particle_spacing);
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
    let scale = decimal(scale, 0.01 * scale);
    (scale, scale * 0.5 * (low + high))
}

/// Adds an emitter that points down from the top of the domain, the first one over its middle.
pub fn add_emitter(scene: &mut Scene) {
    let names: Vec<&str> = scene.emitters.iter().map(|emitter| emitter.name.as_str()).collect();
    let number = free_number(EMITTER, &names);
    let (size, spacing) = (scene.domain.size(), scene.fluid.particle_spacing);
    let radius = decimal((0.08 * size.min_element()).max(2.5 * spacing), spacing);
    let middle = scene.domain.center();
    let top = Vec3::new(middle.x, scene.domain.max.y - 3.0 * spacing, middle.z);
    let position = top + if number > 1 { offset(scene, number) } else { Vec3::ZERO };
    let room = Vec3::new(radius, 0.0, radius).min(0.5 * size);
    let position = position.clamp(scene.domain.min + room, scene.domain.max - room);
    // The speed after a fall through an eighth of the height.
    let speed = (0.25 * size.y * scene.gravity.length()).sqrt().max(EMITTER_MIN_SPEED * size.y);
    // Particles are allocated in advance for the duration of the scene.
    scene.duration = scene.duration.max(EMITTER_TIME);
    let max_particles = (2 * splashdown::check::count(scene)).clamp(20_000, 500_000) as u32;
    scene.emitters.push(Emitter {
        name: format!("{EMITTER}{number}"),
        outlet: Outlet::Disc { radius },
        position: decimals(position, spacing),
        direction: Vec3::NEG_Y,
        speed: decimal(speed, 0.01 * speed),
        start: 0.0,
        end: None,
        max_particles: Some(max_particles),
    });
}

/// Adds an emitter, or removes the one that was added last.
pub fn toggle_emitter(scene: &mut Scene) {
    match added_emitter(scene) {
        Some(index) => drop(scene.emitters.remove(index)),
        None => add_emitter(scene),
    }
}

/// The number of the emitter that was added last, also if the scene was saved since then.
pub fn added_emitter(scene: &Scene) -> Option<usize> {
    let is_added = |name: &str| {
        let number = name.strip_prefix(EMITTER);
        number.is_some_and(|number| !number.is_empty() && number.chars().all(|c| c.is_ascii_digit()))
    };
    scene.emitters.iter().rposition(|emitter| is_added(&emitter.name))
}

/// Whether a scene has fluid at the start or later.
pub fn has_fluid(scene: &Scene) -> bool {
    let fluid = &scene.fluid;
    let counts = [fluid.blocks.len(), fluid.meshes.len(), fluid.files.len(), scene.emitters.len()];
    counts.into_iter().any(|count| count > 0)
}

/// The smallest number from 1 that no name with this beginning has; larger than the number of those names.
fn free_number(beginning: &str, names: &[&str]) -> usize {
    let mut number = names.iter().filter(|name| name.starts_with(beginning)).count() + 1;
    while names.contains(&format!("{beginning}{number}").as_str()) {
        number += 1;
    }
    number
}

/// The horizontal place of an added thing relative to the middle of the domain, in m. Successive ones are placed at
/// multiples of the golden angle, so that they do not collide.
fn offset(scene: &Scene, number: usize) -> Vec3 {
    let (size, angle) = (scene.domain.size(), 2.399_963 * number as f32);
    Vec3::new(0.2 * size.x * angle.cos(), 0.0, 0.2 * size.z * angle.sin())
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
    let names: Vec<&str> = scene.bodies.iter().map(|body| body.name.as_str()).collect();
    let number = free_number(&format!("{name}-"), &names);
    let (low, size) = (scene.domain.min, scene.domain.size());
    let position = low + Vec3::new(0.5, 0.8, 0.5) * size + offset(scene, number);
    let position = decimals(position - middle, scene.fluid.particle_spacing);
    scene.bodies.push(Body {
        name: format!("{name}-{number}"),
        mesh: MeshSource {
            shape,
            scale: Vec3::splat(scale),
            up: UpAxis::Y,
            position,
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
        toggle_emitter(&mut scene);
        let mut simulation = Simulation::new(&scene, &Device::Cpu).unwrap();
        let stats = simulation.advance(0.05).unwrap();
        assert!(stats.emitted > 0, "{stats:?}");
        let positions: Vec<Vec3> =
            simulation.body_states().unwrap().iter().map(|state| state.position).collect();
        assert!(positions[0].distance(positions[1]) > added_size(&scene), "{positions:?}");
        toggle_emitter(&mut scene);
        assert!(scene.emitters.is_empty());
    }

    #[test]
    fn several_emitters_are_valid_and_the_last_one_is_removed() {
        let (name, text) = presets()[1];
        let mut scene = Scene::parse(text, name).unwrap();
        for _ in 0..3 {
            add_emitter(&mut scene);
        }
        let names: Vec<&str> = scene.emitters.iter().map(|emitter| emitter.name.as_str()).collect();
        assert_eq!(names, ["emitter-1", "emitter-2", "emitter-3"]);
        for (a, b) in [(0, 1), (0, 2), (1, 2)] {
            let [a, b] = [a, b].map(|index| &scene.emitters[index]);
            let Outlet::Disc { radius } = a.outlet else { panic!("{a:?}") };
            assert!(a.position.distance(b.position) > 2.0 * radius, "{a:?} {b:?}");
        }
        // The outlets are inside the domain, which reading the scene checks.
        crate::save::scene(&scene, &crate::camera::Orbit::of_scene(&scene)).unwrap();
        toggle_emitter(&mut scene);
        assert_eq!(scene.emitters.len(), 2);
        // Emitters of the scene itself remain.
        scene.emitters[1].name = "inlet".to_owned();
        assert_eq!(added_emitter(&scene), Some(0));
        scene.emitters[0].name = "emitter-left".to_owned();
        assert_eq!(added_emitter(&scene), None);
    }

    #[test]
    fn the_speed_of_an_emitter_follows_the_gravity_of_the_scene() {
        let (name, text) = presets()[1];
        let speed = |gravity: f32| {
            let mut scene = Scene::parse(text, name).unwrap();
            scene.gravity = Vec3::NEG_Y * gravity;
            add_emitter(&mut scene);
            scene.emitters[0].speed
        };
        let height = Scene::parse(text, name).unwrap().domain.size().y;
        for gravity in [9.81, 1.62] {
            let fallen = (2.0 * gravity * height / 8.0).sqrt();
            assert!(
                (speed(gravity) - fallen).abs() < 1e-4 * fallen,
                "{gravity} m/s^2: {} m/s",
                speed(gravity)
            );
        }
        assert!(speed(0.0) > 0.0);
    }
}
