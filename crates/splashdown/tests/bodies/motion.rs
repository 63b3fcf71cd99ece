use glam::Vec3;
use splashdown::scene::{Formula, Hinge, Keyframe, Method, Motion, Scene, Script};
use splashdown::{Device, Simulation};

use crate::{body, free, tank};

fn dry(scene: &mut Scene) {
    // A small block far from the bodies: a scene needs some fluid.
    if let splashdown::scene::Shape::Box { min, size } = &mut scene.fluid.blocks[0].shape {
        (*min, *size) = (Vec3::ZERO, Vec3::splat(0.05));
    }
}

#[test]
fn a_scripted_body_follows_its_script() {
    let mut scene = tank(0.025, [0.6, 0.6, 0.6], 0.1);
    dry(&mut scene);
    let formulas = |texts: [&str; 3]| Some(Box::new(texts.map(|text| Formula::parse(text).unwrap())));
    let keyframe = Keyframe { time: 0.0, position: Vec3::splat(0.4), orientation: glam::Quat::IDENTITY };
    let script = Script {
        keyframes: vec![keyframe],
        shift: formulas(["0.05*sin(20*t)", "0", "0"]),
        turn: formulas(["0", "360*t", "0"]),
    };
    scene.bodies.push(body("mixer", "cube", 0.1, Vec3::ZERO, Motion::Scripted(script.clone())));
    let mut simulation = Simulation::new(&scene, &Device::Cpu).unwrap();
    for k in 1..=5 {
        simulation.advance(0.1).unwrap();
        let (state, pose) = (simulation.body_states().unwrap()[0], script.pose(0.1 * f64::from(k)));
        assert!(state.position.distance(pose.position) < 1e-4, "{state:?} {pose:?}");
        assert!(state.velocity.distance(pose.velocity) < 1e-3, "{state:?} {pose:?}");
        assert!(state.orientation.dot(pose.orientation).abs() > 1.0 - 1e-5, "{state:?} {pose:?}");
    }
}

#[test]
fn a_free_body_falls_and_collides_with_the_floor_and_other_bodies() {
    let mut scene = tank(0.025, [0.8, 1.0, 0.8], 0.1);
    // Without fluid in motion the steps of the default are too long for the gate of the fall.
    scene.solver.select_method(Method::Wcsph);
    dry(&mut scene);
    scene.bodies = vec![
        body("one", "cube", 0.1, Vec3::new(0.4, 0.6, 0.4), free(500.0)),
        body("two", "cube", 0.1, Vec3::new(0.42, 0.75, 0.4), free(900.0)),
        body("far", "cube", 0.1, Vec3::new(0.7, 0.9, 0.7), free(500.0)),
    ];
    let mut simulation = Simulation::new(&scene, &Device::Cpu).unwrap();
    simulation.advance(0.2).unwrap();
    let state = simulation.body_states().unwrap()[2];
    assert!((state.position.y - (0.9 - 0.5 * 9.81 * 0.04)).abs() < 2e-3, "{state:?}");
    assert!((state.velocity.y + 9.81 * 0.2).abs() < 1e-3, "{state:?}");
    for _ in 0..10 {
        simulation.advance(0.1).unwrap();
        for state in simulation.body_states().unwrap() {
            // In any orientation, the centre of a cube is at least half an edge above the floor.
            assert!(state.position.y > 0.05 - 0.004, "{state:?}");
            assert!(state.position.min_element() > 0.04 && state.position.max_element() < 1.0, "{state:?}");
        }
    }
    let states = simulation.body_states().unwrap();
    assert!(states[0].position.distance(states[1].position) > 0.095, "{states:?}");
    assert!(states.iter().all(|state| state.velocity.length() < 1.0), "{states:?}");
}

#[test]
fn detailed_and_hollow_bodies_collide() {
    let mut scene = tank(0.025, [1.0, 1.0, 1.0], 0.1);
    dry(&mut scene);
    scene.bodies = vec![
        body("ball", "sphere", 1.0, Vec3::new(0.3, 0.3, 0.3), free(500.0)),
        body("block", "block", 1.0, Vec3::new(0.7, 0.3, 0.7), free(500.0)),
        body("gear", "gear", 0.8, Vec3::new(0.5, 0.6, 0.5), free(500.0)),
    ];
    scene.bodies[2].mesh.rotation = glam::Quat::from_rotation_x(1.3);
    let mut simulation = Simulation::new(&scene, &Device::Cpu).unwrap();
    simulation.advance(1.0).unwrap();
    for (state, least) in simulation.body_states().unwrap().iter().zip([0.09, 0.09, 0.0]) {
        assert!(state.position.y > least, "{state:?}");
        assert!(state.position.max_element() < 1.0 && state.position.min_element() > 0.0, "{state:?}");
        assert!(state.velocity.length() < 3.0, "{state:?}");
    }
}

#[test]
fn a_hinged_body_swings_like_a_physical_pendulum_in_one_plane() {
    let mut scene = tank(0.025, [1.0, 1.0, 1.0], 0.1);
    dry(&mut scene);
    let (edge, arm) = (0.1, 0.2);
    let mut swing = body("swing", "cube", edge, Vec3::new(0.5 + arm * 0.1, 0.7 - arm, 0.5), free(800.0));
    let hinge_point = Vec3::new(0.5, 0.7, 0.5);
    if let Motion::Dynamic { hinge, .. } = &mut swing.motion {
        *hinge = Some(Hinge { point: hinge_point, axis: Vec3::Z });
    }
    let length = swing.mesh.position.distance(hinge_point);
    scene.bodies.push(swing);
    let mut simulation = Simulation::new(&scene, &Device::Cpu).unwrap();
    // Physical pendulum: T = 2 pi sqrt((I + m l^2) / (m g l)), I = m edge^2 / 6, plus 0.06 % for the amplitude of 0.1.
    let exact = std::f32::consts::TAU * ((edge * edge / 6.0 + length * length) / (9.81 * length)).sqrt();
    let mut before = 1.0;
    let mut passes = Vec::new();
    for k in 0..120 {
        simulation.advance(0.01).unwrap();
        let state = simulation.body_states().unwrap()[0];
        assert!((state.position.distance(hinge_point) - length).abs() < 1e-4, "{state:?}");
        assert!((state.position.z - 0.5).abs() < 1e-5 && state.angular_velocity.truncate().length() < 1e-4);
        let x = state.position.x - 0.5;
        if x * before < 0.0 {
            passes.push(0.01 * (k as f32 + before / (before - x)));
        }
        before = x;
    }
    let period = 2.0 * (passes[1] - passes[0]);
    assert!((period / exact - 1.0).abs() < 0.01, "{period} of {exact} s: {passes:?}");
}
