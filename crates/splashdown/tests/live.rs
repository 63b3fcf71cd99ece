//! Changes of a running simulation.

use glam::Vec3;
use splashdown::scene::{Body, BoundaryKind, InitialPressure, MeshSource, Motion, Scene, SkyKind};
use splashdown::{Device, MouseForce, Simulation};
use splashdown_gpu::block_on;

fn scene() -> Scene {
    let text = include_str!("../scenes/dam-break-small.toml");
    let mut scene = Scene::parse(text, "dam-break-small.toml").unwrap();
    scene.fluid.particle_spacing *= 1.5;
    scene
}

fn mean_velocity(simulation: &mut Simulation) -> Vec3 {
    let velocities = simulation.particles().unwrap().velocities;
    velocities.iter().map(|&v| Vec3::from(v)).sum::<Vec3>() / velocities.len() as f32
}

#[test]
fn the_mouse_force_accelerates_water_only_while_it_is_active() {
    let mut scene = scene();
    scene.gravity = Vec3::ZERO;
    let mut simulation = Simulation::new(&scene, &Device::Cpu).unwrap();
    let middle = scene.fluid.blocks[0].shape.bounds();
    let origin = 0.5 * (middle.0 + middle.1);
    let mouse_force = MouseForce::new(origin, Vec3::NEG_Z, Vec3::new(0.5, 0.0, 0.0), 1.0, 10.0);
    simulation.set_mouse_force(Some(mouse_force)).unwrap();
    simulation.advance(0.05).unwrap();
    let carried = mean_velocity(&mut simulation);
    assert!(carried.x > 0.05, "{carried}");
    simulation.set_mouse_force(None).unwrap();
    simulation.advance(0.02).unwrap();
    let after = mean_velocity(&mut simulation);
    // Control: without the mouse force the water is not accelerated.
    assert!((after.x - carried.x).abs() < 0.2 * carried.x, "{carried} then {after}");
}

#[test]
fn update_parameters_accepts_constants_and_rejects_structural_changes() {
    let mut scene = scene();
    // Gravity along x replaces the one along y, so that no pressure along y remains.
    scene.fluid.initial_pressure = InitialPressure::Zero;
    let mut simulation = Simulation::new(&scene, &Device::Cpu).unwrap();
    scene.gravity = Vec3::new(3.0, 0.0, 0.0);
    scene.fluid.material.viscosity = 0.01;
    scene.solver.artificial_viscosity = 0.2;
    scene.picture.sky = SkyKind::Sunset;
    assert!(simulation.update_parameters(&scene).unwrap());
    simulation.advance(0.01).unwrap();
    let v = mean_velocity(&mut simulation);
    assert!(v.x > 0.01 && v.y.abs() < 0.1 * v.x, "{v}");
    for change in [
        |scene: &mut Scene| scene.fluid.particle_spacing *= 2.0,
        |scene: &mut Scene| scene.fluid.material.rest_density *= 2.0,
        |scene: &mut Scene| scene.domain.max.y *= 1.5,
        |scene: &mut Scene| scene.solver.support_ratio = 2.5,
    ] {
        let mut other = scene.clone();
        change(&mut other);
        assert!(!simulation.update_parameters(&other).unwrap());
        assert_eq!(simulation.scene(), &scene);
    }
}

fn ball(name: &str, position: Vec3) -> Body {
    let mut scene = Scene::parse(
        &format!(
            "{}\n[[body]]\nname = {name:?}\nmesh = \"sphere\"\nscale = 0.1\nmotion = \"dynamic\"\ndensity = 300\n",
            include_str!("../scenes/dam-break-small.toml")
        ),
        "ball.toml",
    )
    .unwrap();
    let mut body = scene.bodies.remove(0);
    body.mesh = MeshSource { position, ..body.mesh };
    body.boundary = BoundaryKind::Map;
    assert!(matches!(body.motion, Motion::Dynamic { .. }));
    body
}

#[test]
fn a_body_added_to_a_running_simulation_displaces_water() {
    let mut scene = scene();
    let mut simulation = Simulation::new(&scene, &Device::Cpu).unwrap();
    simulation.advance(0.05).unwrap();
    let before = simulation.particles().unwrap();
    let top = scene.domain.max;
    scene.bodies.push(ball("first", Vec3::new(0.7 * top.x, 0.7 * top.y, 0.5 * top.z)));
    let mut second = simulation.rebuild_with(&scene).unwrap();
    assert_eq!(second.particles().unwrap().positions, before.positions);
    assert_eq!(second.particles().unwrap().ids, before.ids);
    assert_eq!(second.stats().time, simulation.stats().time);
    second.advance(0.05).unwrap();
    let fallen = second.body_states().unwrap()[0];
    assert!(fallen.velocity.y < -0.3, "{fallen:?}");

    // A second ball: the first keeps its position and velocity; a ball inside the water replaces particles.
    let inside = Vec3::from(second.particles().unwrap().positions[before.ids.len() / 2]);
    scene.bodies.push(ball("second", inside));
    let mut third = second.rebuild_with(&scene).unwrap();
    let states = third.body_states().unwrap();
    assert!(states[0].position.distance(fallen.position) < 1e-5, "{states:?}");
    assert!(states[0].velocity.distance(fallen.velocity) < 1e-5, "{states:?}");
    assert!(third.removed() > 0);
    let particles = third.particles().unwrap();
    assert_eq!(third.inside_bodies(&particles).unwrap(), 0);
    third.advance(0.02).unwrap();
}

#[test]
fn a_dragged_body_follows_and_does_not_leak() {
    let mut scene = scene();
    let top = scene.domain.max;
    scene.bodies.push(ball("held", Vec3::new(0.7 * top.x, 0.3 * top.y, 0.5 * top.z)));
    let mut simulation = Simulation::new(&scene, &Device::Cpu).unwrap();
    let (anchor, target) = (Vec3::new(0.0, 0.03, 0.0), Vec3::new(0.6 * top.x, 0.8 * top.y, 0.5 * top.z));
    for _ in 0..60 {
        block_on(simulation.pull_body_async(0, anchor, target, 12.0)).unwrap();
        simulation.advance(0.01).unwrap();
    }
    let state = simulation.body_states().unwrap()[0];
    let held = state.position + state.orientation * anchor;
    // It sags by the distance that it falls between two updates.
    assert!(held.distance(target) < 0.02, "{held} is not near {target}");
    let particles = simulation.particles().unwrap();
    assert_eq!(simulation.inside_bodies(&particles).unwrap(), 0);
    // Control: after release it falls.
    simulation.advance(0.2).unwrap();
    let fallen = simulation.body_states().unwrap()[0];
    assert!(fallen.position.y < state.position.y - 0.05, "{fallen:?}");
}

/// A change of a running scene must not put scripted bodies back to where they were at the start.
#[test]
fn a_scripted_body_continues_its_motion_in_a_changed_scene() {
    let text = format!(
        "{}\n[[body]]\nname = \"paddle\"\nmesh = \"cube\"\nscale = 0.1\nposition = [0.8, 0.3, 0.2]\n\
         move = [\"0.5*t\", \"0\", \"0\"]\n",
        include_str!("../scenes/dam-break-small.toml")
    );
    let mut scene = Scene::parse(&text, "paddle.toml").unwrap();
    scene.fluid.particle_spacing *= 1.5;
    let mut simulation = Simulation::new(&scene, &Device::Cpu).unwrap();
    let start = simulation.body_states().unwrap()[0].position;
    simulation.advance(0.1).unwrap();
    let moved = simulation.body_states().unwrap()[0];
    assert!((moved.position.x - start.x - 0.05).abs() < 1e-5, "{moved:?}");
    scene.domain.max.y *= 1.25;
    let mut next = simulation.rebuild_with(&scene).unwrap();
    let continued = next.body_states().unwrap()[0];
    assert!(continued.position.distance(moved.position) < 1e-5, "{continued:?}");
    assert!((continued.velocity.x - 0.5).abs() < 1e-5, "{continued:?}");
}

#[test]
fn a_wider_support_of_the_surface_needs_another_grid() {
    let mut scene = scene();
    let mut simulation = Simulation::new(&scene, &Device::Cpu).unwrap();
    scene.surface.cell_size *= 1.1;
    assert!(simulation.update_parameters(&scene).unwrap());
    scene.surface.support_ratio *= 1.5;
    assert!(!simulation.update_parameters(&scene).unwrap());
}
