use glam::{Quat, Vec3};
use splashdown::scene::{Body, Hinge, Motion, Scene, Shape};
use splashdown::{Device, Event, Run, RunOptions, Simulation};

use crate::{body, free, tank};

/// Runs a scene; no particle may enter a body or need a wall correction.
fn run_tight(scene: &Scene, tenths: u32) -> Simulation {
    run_corrected(scene, tenths, 0)
}

/// Runs a scene; no particle may enter a body at the end of a tenth of a second. At most `most` wall corrections.
fn run_corrected(scene: &Scene, tenths: u32, most: u32) -> Simulation {
    let mut simulation = Simulation::new(scene, &Device::Cpu).unwrap();
    for _ in 0..tenths {
        let stats = simulation.advance(0.1).unwrap();
        let particles = simulation.particles().unwrap();
        assert_eq!(simulation.inside_bodies(&particles).unwrap(), 0, "at {} s", stats.time);
        assert!(stats.wall_corrections <= most && stats.non_finite == 0, "{stats:?}");
    }
    simulation
}

#[test]
fn sixty_four_bodies_float_at_once() {
    // Far enough apart that no two bodies enclose a particle between them.
    let mut scene = tank(0.03, [1.2, 0.45, 1.2], 0.15);
    for k in 0..64 {
        let place = Vec3::new(0.075 + 0.15 * (k % 8) as f32, 0.2, 0.075 + 0.15 * (k / 8) as f32);
        let mut cube = body(&format!("cube-{k}"), "cube", 0.08, place, free(200.0 + 5.0 * k as f32));
        cube.mesh.rotation = Quat::from_rotation_y(0.3 * k as f32);
        scene.bodies.push(cube);
    }
    let mut simulation = run_tight(&scene, 3);
    let states = simulation.body_states().unwrap();
    assert_eq!(states.len(), 64);
    // Control: all bodies have moved, and none has left the tank.
    assert!(states.iter().all(|state| (state.position.y - 0.2).abs() > 1e-3), "{states:?}");
    let inside = |x: Vec3| x.cmpgt(Vec3::ZERO).all() && x.cmplt(Vec3::new(1.2, 0.45, 1.2)).all();
    assert!(states.iter().all(|state| inside(state.position)), "{states:?}");
}

/// Balls of four spacings fall into water, onto one another and onto the floor: 8, or 64 with `SPLASHDOWN_FULL=1`.
#[test]
fn balls_that_fall_into_a_tank_do_not_burst_the_water() {
    let (side, seconds) = if std::env::var_os("SPLASHDOWN_FULL").is_some() { (4, 2.0) } else { (2, 0.6) };
    let (spacing, radius, pitch, depth) = (0.025, 0.05, 0.24, 0.35);
    let edge = pitch * side as f32 + 0.04;
    let height = depth + 0.2 * side as f32 + 0.1;
    let mut scene = tank(spacing, [edge, height, edge], depth);
    for k in 0..side * side * side {
        let [i, j, l] = [k % side, k / side % side, k / side / side].map(|n| n as f32);
        // The columns lean, so that balls meet.
        let place = Vec3::new(0.14 + pitch * i - 0.03 * j, depth + 0.12 + 0.2 * j, 0.14 + pitch * l);
        let density = [200.0, 500.0, 900.0, 2000.0][k % 4];
        scene.bodies.push(body(&format!("ball-{k}"), "sphere", radius / 0.1, place, free(density)));
    }
    let mut simulation = Simulation::new(&scene, &Device::Cpu).unwrap();
    let fastest = (2.0 * 9.81 * height).sqrt();
    let (mut corrections, mut speed, mut inside, mut nearest) = (0, 0.0f32, 0, f32::MAX);
    let rounds = (20.0 * seconds) as u32;
    for round in 1..=rounds {
        let stats = simulation.advance(0.05).unwrap();
        let particles = simulation.particles().unwrap();
        (corrections, speed) = (stats.wall_corrections, speed.max(stats.max_speed));
        inside = inside.max(simulation.inside_bodies(&particles).unwrap());
        // Balls that hit one another overlap by what they move in a step, a fifth of a spacing, until the next one.
        let overlap = if round < rounds { 0.2 * spacing } else { 0.04 * radius };
        let places: Vec<Vec3> =
            simulation.body_states().unwrap().iter().map(|state| state.position).collect();
        for (k, a) in places.iter().enumerate() {
            let wall = a.min(Vec3::new(edge, height, edge) - *a).min_element();
            assert!(wall > radius - overlap, "ball {k} is {wall} m from a wall at {} s", stats.time);
            for b in &places[..k] {
                let apart = a.distance(*b);
                assert!(apart > 2.0 * radius - overlap, "{a} {b}: {apart} m at {} s", stats.time);
                nearest = nearest.min(apart);
            }
        }
    }
    eprintln!("{corrections} wall corrections, at most {inside} particles inside, at most {speed} m/s");
    assert!(speed < 3.0 * fastest, "{speed} of {fastest} m/s");
    assert!(inside <= 2, "{inside} particles are inside a body");
    // Control: balls meet.
    assert!(nearest < 2.1 * radius, "{nearest}");
}

#[test]
fn overlapping_bodies_are_watertight() {
    // A dam of two rotated, intersecting cubes across the tank, with water on one side.
    let mut scene = tank(0.025, [0.8, 0.4, 0.3], 0.2);
    if let Shape::Box { size, .. } = &mut scene.fluid.blocks[0].shape {
        size.x = 0.3;
    }
    for (name, z, angle) in [("near", 0.05, 0.2), ("far", 0.25, -0.3)] {
        let mut cube = body(name, "cube", 0.3, Vec3::new(0.5, 0.15, z), Motion::Static);
        cube.mesh.rotation = Quat::from_rotation_y(angle);
        scene.bodies.push(cube);
    }
    let mut simulation = run_tight(&scene, 8);
    let particles = simulation.particles().unwrap();
    let behind = particles.positions.iter().filter(|x| x[0] > 0.68).count();
    assert_eq!(behind, 0, "particles behind the dam");
    let beside = particles.positions.iter().filter(|x| x[0] > 0.31).count();
    assert!(beside > 50, "the water never reached the dam");
}

/// A beaker of zero thickness, full of water, with its opening on the floor.
fn upside_down_beaker(scene: &mut Scene) -> Body {
    let mut cup = body("beaker", "thin-cup", 4.0, Vec3::new(0.3, 0.4, 0.3), Motion::Static);
    cup.mesh.rotation = Quat::from_rotation_x(std::f32::consts::PI);
    if let Shape::Box { min, size } = &mut scene.fluid.blocks[0].shape {
        (*min, *size) = (Vec3::new(0.22, 0.0, 0.22), Vec3::new(0.16, 0.36, 0.16));
    }
    cup
}

#[test]
fn an_upside_down_beaker_of_zero_thickness_holds_water() {
    let mut scene = tank(0.02, [0.6, 0.5, 0.6], 0.36);
    let cup = upside_down_beaker(&mut scene);
    scene.bodies.push(cup);
    // At the inner edge the beaker acts as one plane. A particle that slides along it enters the wall by a few hundredths of a
    // spacing and is moved back: 0 to 12 times, depending on the lengths of the steps.
    let mut simulation = run_corrected(&scene, 6, 20);
    let particles = simulation.particles().unwrap();
    let out = |x: &&[f32; 3]| Vec3::from(**x).with_y(0.0).distance(Vec3::new(0.3, 0.0, 0.3)) > 0.18;
    assert_eq!(particles.positions.iter().filter(out).count(), 0, "particles outside the beaker");
    // Control: without the beaker the water spreads.
    scene.bodies.clear();
    let mut free = Simulation::new(&scene, &Device::Cpu).unwrap();
    free.advance(0.4).unwrap();
    assert!(free.particles().unwrap().positions.iter().filter(out).count() > 100);
}

#[test]
fn a_water_jet_turns_a_paddle_wheel() {
    let mut scene = tank(0.025, [1.2, 0.6, 0.3], 0.15);
    scene.fluid.blocks[0].velocity = Vec3::new(1.0, 0.0, 0.0);
    let mut wheel = body("wheel", "paddle-wheel", 1.0, Vec3::new(0.6, 0.32, 0.15), free(600.0));
    if let Motion::Dynamic { hinge, .. } = &mut wheel.motion {
        *hinge = Some(Hinge { point: Vec3::new(0.6, 0.32, 0.15), axis: Vec3::Z, motor: None });
    }
    scene.bodies.push(wheel);
    let mut simulation = run_tight(&scene, 3);
    let state = simulation.body_states().unwrap()[0];
    assert!(state.position.distance(Vec3::new(0.6, 0.32, 0.15)) < 1e-4, "{state:?}");
    // Water that flows along +x under the axle turns the wheel counter-clockwise, seen from +z.
    assert!(state.angular_velocity.z > 0.5, "{state:?}");
}

#[test]
fn a_body_that_leaves_the_domain_is_reported_once() {
    let mut scene = tank(0.05, [0.4, 0.4, 0.4], 0.1);
    scene.domain.closed[1][1] = false;
    scene.duration = 0.4;
    let up = Motion::Dynamic {
        density: 2500.0,
        velocity: Vec3::new(0.0, 8.0, 0.0),
        angular_velocity: Vec3::ZERO,
        hinge: None,
    };
    scene.bodies.push(body("stone", "cube", 0.1, Vec3::new(0.2, 0.3, 0.2), up));
    let options = RunOptions::new(&scene).with_device(Device::Cpu).with_surface(false);
    let warnings = Run::new(&scene, options).unwrap().filter_map(|event| match event.unwrap() {
        Event::Warning(text) if text.contains("body \"stone\" has left the domain") => Some(text),
        _ => None,
    });
    assert_eq!(warnings.count(), 1);
}
