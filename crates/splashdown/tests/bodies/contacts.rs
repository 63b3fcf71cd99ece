//! Restitution and friction between solids.

use glam::Vec3;
use splashdown::scene::{Method, Motion, Scene};
use splashdown::{Device, Simulation};

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
