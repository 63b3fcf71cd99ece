//! Restitution and friction between solids.

use glam::{Quat, Vec3};
use splashdown::scene::{Hinge, MeshShape, Method, Motion, Scene, Shape};
use splashdown::{Device, Simulation, SimulationError};

use crate::{body, dry, free, tank};

const GRAVITY: f32 = 9.81;

/// A wide dry tank.
fn room() -> Scene {
    let mut scene = tank(0.025, [1.6, 1.0, 0.6], 0.1);
    dry(&mut scene);
    scene
}

fn moving(density: f32, velocity: Vec3) -> Motion {
    Motion::Dynamic { density, velocity, angular_velocity: Vec3::ZERO, hinge: None }
}

#[test]
fn a_ball_bounces_to_the_height_of_its_restitution() {
    for method in [Method::Dfsph, Method::Wcsph] {
        for restitution in [0.0, 0.5, 0.9] {
            let mut scene = room();
            scene.solver.select_method(method);
            let (radius, drop) = (0.1, 0.5);
            scene.bodies = vec![body("ball", "sphere", 1.0, Vec3::new(0.8, radius + drop, 0.3), free(900.0))];
            scene.bodies[0].contact.restitution = restitution;
            let mut simulation = Simulation::new(&scene, &Device::Cpu).unwrap();
            let fall = (2.0 * drop / GRAVITY).sqrt();
            // The ball is at its highest point at this time after the impact.
            simulation.advance(fall + restitution * fall).unwrap();
            let state = simulation.body_states().unwrap()[0];
            let (height, expected) = (state.position.y - radius, restitution * restitution * drop);
            assert!(
                (height - expected).abs() < 0.04 * drop,
                "{method:?} {restitution}: {height} of {expected} m"
            );
        }
    }
}

/// Contacts that are solved in too few iterations push the corners of a box apart in their order: it crept 10 mm in 3 s.
#[test]
fn a_box_at_rest_stays_where_it_is() {
    let mut scene = room();
    let place = Vec3::new(0.8, 0.1001, 0.3);
    scene.bodies = vec![body("box", "cube", 0.2, place, free(1000.0))];
    let mut simulation = Simulation::new(&scene, &Device::Cpu).unwrap();
    simulation.advance(3.0).unwrap();
    let moved = simulation.body_states().unwrap()[0].position - place;
    assert!(moved.with_y(0.0).length() < 0.002 && moved.y.abs() < 0.001, "{moved}");
}

#[test]
fn a_block_slides_as_far_as_its_friction_allows() {
    let speed = 1.0;
    for (friction, time) in [(0.5, 0.5), (0.15, 1.0), (0.0, 0.5)] {
        let mut scene = room();
        // Its steps are short: a step of the default ends a motion too early by half its length.
        scene.solver.select_method(Method::Wcsph);
        // A flat block, which does not tip.
        let place = Vec3::new(0.3, 0.025, 0.3);
        scene.bodies = vec![body("block", "cube", 1.0, place, moving(700.0, Vec3::new(speed, 0.0, 0.0)))];
        scene.bodies[0].mesh.scale = Vec3::new(0.2, 0.05, 0.2);
        scene.bodies[0].contact.friction = friction;
        let mut simulation = Simulation::new(&scene, &Device::Cpu).unwrap();
        simulation.advance(time).unwrap();
        let state = simulation.body_states().unwrap()[0];
        let stop = if friction > 0.0 { speed / (friction * GRAVITY) } else { f32::INFINITY };
        let moves = time.min(stop);
        let expected = speed * moves - 0.5 * friction * GRAVITY * moves * moves;
        let slid = state.position.x - place.x;
        assert!((slid - expected).abs() < 0.03 * expected, "{friction}: {slid} of {expected} m, {state:?}");
    }
}

#[test]
fn bodies_exchange_momentum_by_the_mean_of_their_restitutions() {
    let mut scene = room();
    scene.gravity = Vec3::ZERO;
    let toward = Vec3::new(1.5, 0.0, 0.0);
    scene.bodies = vec![
        body("fast", "sphere", 0.5, Vec3::new(0.4, 0.5, 0.3), moving(1000.0, toward)),
        body("heavy", "sphere", 0.5, Vec3::new(0.8, 0.5, 0.3), moving(3000.0, Vec3::ZERO)),
    ];
    scene.bodies[0].contact.restitution = 1.0;
    scene.bodies[1].contact.restitution = 0.6;
    let mut simulation = Simulation::new(&scene, &Device::Cpu).unwrap();
    simulation.advance(0.35).unwrap();
    let states = simulation.body_states().unwrap();
    // With masses 1 and 3 and a restitution of 0.8: v1 = (1 - 3 * 0.8) / 4 v, v2 = 1.8 / 4 v.
    for (state, expected) in states.iter().zip([-0.35 * toward, 0.45 * toward]) {
        assert!(state.velocity.distance(expected) < 0.03 * toward.x, "{state:?} {expected}");
    }
}

/// An upright prism of this many sides, 1 m wide and high, as OBJ.
fn prism(sides: usize) -> String {
    let angles = (0..sides).map(|k| std::f32::consts::TAU * k as f32 / sides as f32);
    let corner = |y: f32, angle: f32| format!("v {} {y} {}\n", 0.5 * angle.cos(), 0.5 * angle.sin());
    let mut text: String = angles.flat_map(|angle| [corner(-0.5, angle), corner(0.5, angle)]).collect();
    for k in 0..sides {
        let next = (k + 1) % sides;
        text += &format!("f {} {} {} {}\n", 2 * k + 1, 2 * k + 2, 2 * next + 2, 2 * next + 1);
    }
    let face = |first: usize| (0..sides).map(move |k| format!(" {}", 2 * k + first)).collect::<String>();
    text + &format!(
        "f{}\nf{}\n",
        face(1),
        (0..sides).rev().map(|k| format!(" {}", 2 * k + 2)).collect::<String>()
    )
}

/// Parry tests four corners of a face against a plane: a cylinder with 24 sides tipped over and sank by 71 % of its height.
#[test]
fn a_prism_stands_on_the_floor() {
    let folder = tempfile::tempdir().unwrap();
    for sides in [3, 6, 24] {
        let path = folder.path().join(format!("{sides}.obj"));
        std::fs::write(&path, prism(sides)).unwrap();
        let mut scene = room();
        let size = 0.2;
        let mut solid = body("prism", "cube", size, Vec3::new(0.8, 0.5 * size + 0.05, 0.3), free(3000.0));
        solid.mesh.shape = MeshShape::File(path);
        scene.bodies = vec![solid];
        let mut simulation = Simulation::new(&scene, &Device::Cpu).unwrap();
        for _ in 0..20 {
            simulation.advance(0.05).unwrap();
            let state = simulation.body_states().unwrap()[0];
            let lowest = (0..sides).flat_map(|k| {
                let angle = std::f32::consts::TAU * k as f32 / sides as f32;
                [-0.5, 0.5].map(|y| size * Vec3::new(0.5 * angle.cos(), y, 0.5 * angle.sin()))
            });
            let lowest =
                lowest.map(|x| (state.position + state.orientation * x).y).fold(f32::INFINITY, f32::min);
            assert!(lowest > -0.03 * size, "{sides} sides: {lowest} m, {state:?}");
        }
        let state = simulation.body_states().unwrap()[0];
        assert!((state.position.y - 0.5 * size).abs() < 0.01 * size, "{sides} sides: {state:?}");
    }
}

/// A hinged body has the energy that its restitution leaves. Its centre of mass is not its position: with the velocity of the
/// hinge for it, each contact left a part of the spin, and the body stood still in the air.
#[test]
fn a_pendulum_rebounds_from_a_wall() {
    for restitution in [0.0, 1.0] {
        let mut scene = room();
        let hinge = Vec3::new(0.05, 0.9, 0.3);
        let mut rod = body("rod", "cube", 1.0, Vec3::new(0.3, 0.9, 0.3), free(2000.0));
        rod.mesh.scale = Vec3::new(0.5, 0.05, 0.05);
        rod.contact.restitution = restitution;
        if let Motion::Dynamic { hinge: place, .. } = &mut rod.motion {
            *place = Some(Hinge { point: hinge, axis: Vec3::Z, motor: None });
        }
        scene.bodies = vec![rod];
        let mut simulation = Simulation::new(&scene, &Device::Cpu).unwrap();
        let (mut fastest, mut before, mut highest_after) = (0.0_f32, f32::NEG_INFINITY, f32::NEG_INFINITY);
        for _ in 0..110 {
            simulation.advance(0.01).unwrap();
            let state = simulation.body_states().unwrap()[0];
            let spin = state.angular_velocity.z;
            (fastest, before) = (fastest.max(spin.abs()), before.max(-spin));
            if spin > 0.0 {
                highest_after = highest_after.max(state.position.y);
            }
        }
        // It falls by a quarter turn; its lower end meets the wall at x = 0 shortly before it hangs.
        assert!(before > 7.0, "the rod does not fall: {before} rad/s");
        assert!(fastest < 1.03 * before, "{restitution}: {fastest} after {before} rad/s");
        let height = (highest_after - (hinge.y - 0.25)) / 0.25;
        if restitution > 0.0 {
            assert!((0.85..1.02).contains(&height), "an elastic impact: {height} of its height");
        } else {
            assert!(height < 0.2, "an inelastic impact: {height} of its height");
        }
    }
}

/// In f32 the determinant of the inertia of a ball of 4 mm is zero: it was refused as a body without a volume.
#[test]
fn small_bodies_have_a_mass() {
    let drop = |scale: f32, spacing: f32| {
        let mut scene = tank(spacing, [0.02, 0.02, 0.02], 0.002);
        dry(&mut scene);
        if let Shape::Box { size, .. } = &mut scene.fluid.blocks[0].shape {
            *size = Vec3::splat(0.002);
        }
        scene.bodies = vec![body("ball", "sphere", scale, Vec3::new(0.01, 0.01, 0.01), free(2000.0))];
        let mut simulation = Simulation::new(&scene, &Device::Cpu)?;
        simulation.advance(0.02)?;
        Ok::<_, SimulationError>(simulation.body_states()?[0].position.y)
    };
    // The model is 0.2 m across: balls of 4 and 1 mm.
    for scale in [0.02, 0.005] {
        let fallen = 0.01 - drop(scale, 5e-4).unwrap();
        assert!((fallen / (0.5 * GRAVITY * 4e-4) - 1.0).abs() < 0.2, "{scale}: {fallen} m");
    }
    // A ball of 20 um at a spacing of 0.5 mm.
    let refused = drop(1e-4, 5e-4).unwrap_err().to_string();
    assert!(refused.contains("too small for this particle_spacing"), "{refused}");
}

/// A hinged body cannot move along a normal that passes near its hinge. Rapier turned it at tens of radians per second to end
/// such an overlap, and threw other bodies away.
#[test]
fn a_hinged_body_that_overlaps_the_floor_does_not_spin() {
    let mut scene = room();
    let middle = Vec3::new(0.8, 0.12, 0.3);
    // The lowest corner is 2 cm below the floor, and 0.1 of its distance beside the hinge.
    let mut wheel = body("wheel", "cube", 0.2, middle, free(500.0));
    wheel.mesh.rotation = Quat::from_rotation_z((45.0_f32 - 5.7).to_radians());
    if let Motion::Dynamic { hinge, .. } = &mut wheel.motion {
        *hinge = Some(Hinge { point: middle, axis: Vec3::Z, motor: None });
    }
    let before = wheel.mesh.rotation;
    scene.bodies = vec![wheel];
    let mut simulation = Simulation::new(&scene, &Device::Cpu).unwrap();
    simulation.advance(0.05).unwrap();
    let state = simulation.body_states().unwrap()[0];
    assert!(
        state.orientation.angle_between(before) < 0.02 && state.angular_velocity.length() < 0.5,
        "{state:?}"
    );
}
