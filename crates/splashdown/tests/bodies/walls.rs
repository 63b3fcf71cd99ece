use std::sync::Mutex;

use glam::Vec3;
use splashdown::scene::{Body, BoundaryKind, Motion, Scene};
use splashdown::{Device, Simulation};
use splashdown_gpu::{CpuExecutor, Executor};

use crate::{body, tank};

/// A tank whose floor is the side of the domain, or a slab with this boundary.
fn settled(slab: Option<BoundaryKind>) -> (f32, f32) {
    let spacing = 0.025;
    let mut scene = tank(spacing, [0.3, 0.6, 0.3], 0.25);
    if let Some(kind) = slab {
        lift(&mut scene, 0.2);
        // A slab larger than the tank, so that its edges lie outside.
        let mut floor: Body = body("floor", "cube", 0.4, Vec3::new(0.15, 0.0, 0.15), Motion::Static);
        floor.boundary = kind;
        scene.bodies.push(floor);
    }
    let bottom = if slab.is_some() { 0.2 } else { 0.0 };
    let mut simulation = Simulation::new(&scene, &Device::Cpu).unwrap();
    // The measurement begins when the water is at rest.
    simulation.advance(1.0).unwrap();
    let (mut densities, mut load, mut count) = (0.0, 0.0, 0);
    let mut layer = 0;
    const SAMPLES: u32 = 20;
    for _ in 0..SAMPLES {
        simulation.advance(0.02).unwrap();
        let particles = simulation.particles().unwrap();
        for (x, density) in particles.positions.iter().zip(&particles.densities) {
            // The first layer, away from the sides.
            let inner = (x[0] - 0.15).abs() < 0.08 && (x[2] - 0.15).abs() < 0.08;
            if inner && x[1] - bottom < spacing {
                densities += density;
                layer += 1;
            }
        }
        if let Some(body) = simulation.body_states().unwrap().first() {
            load -= body.force.y;
            count += 1;
        }
    }
    (densities / layer as f32, load / count.max(1) as f32)
}

fn lift(scene: &mut Scene, height: f32) {
    for block in &mut scene.fluid.blocks {
        if let splashdown::scene::Shape::Box { min, .. } = &mut block.shape {
            min.y += height;
        }
    }
}

#[test]
fn plane_mesh_and_particle_boundaries_agree() {
    let (plane, _) = settled(None);
    let (map, map_load) = settled(Some(BoundaryKind::Map));
    let (particles, particles_load) = settled(Some(BoundaryKind::Particles));
    eprintln!("density {plane:.1} {map:.1} {particles:.1}, load {map_load:.2} {particles_load:.2} N");
    // Gates: densities agree within 2 %, forces within 5 %.
    for other in [map, particles] {
        assert!((other / plane - 1.0).abs() < 0.02, "density {other} instead of {plane} at a plane");
    }
    let scene = tank(0.025, [0.3, 0.6, 0.3], 0.25);
    let derived = splashdown::scene::Derived::new(&scene);
    let weight = derived.particle_mass * derived.particles as f32 * 9.81;
    for load in [map_load, particles_load] {
        assert!((load / weight - 1.0).abs() < 0.05, "{load} N for a weight of {weight} N");
    }
}

#[test]
fn a_dam_break_against_a_rotated_block_does_not_leak() {
    let mut scene = tank(0.025, [1.2, 0.6, 0.4], 0.3);
    if let splashdown::scene::Shape::Box { size, .. } = &mut scene.fluid.blocks[0].shape {
        size.x = 0.4;
    }
    let mut block = body("block", "cube", 0.2, Vec3::new(0.8, 0.1, 0.2), Motion::Static);
    block.mesh.rotation = glam::Quat::from_rotation_y(0.5);
    scene.bodies.push(block);
    let mut simulation = Simulation::new(&scene, &Device::Cpu).unwrap();
    let mut pushed = 0.0f32;
    for _ in 0..10 {
        let stats = simulation.advance(0.1).unwrap();
        let particles = simulation.particles().unwrap();
        assert_eq!(simulation.inside_bodies(&particles).unwrap(), 0, "at {} s", stats.time);
        assert_eq!(
            (stats.wall_corrections, stats.escaped, stats.non_finite),
            (0, 0, 0),
            "at {} s",
            stats.time
        );
        pushed = pushed.max(simulation.body_states().unwrap()[0].force.x);
    }
    // Control: the wave reached the block.
    assert!(pushed > 5.0, "{pushed} N");
}

/// The window shows a distance field as unfinished until the last part is 1.
#[test]
fn the_progress_of_a_distance_field_ends_at_one() {
    let mut scene = tank(0.03, [0.6, 0.4, 0.4], 0.1);
    // A size that no cached distance field has.
    let size = 0.1 + 1e-6 * (std::process::id() % 10_000) as f32;
    scene.bodies.push(body("block", "cube", size, Vec3::new(0.3, 0.2, 0.2), Motion::Static));
    let parts = Mutex::new(Vec::new());
    let executor = Executor::from(CpuExecutor::new());
    let progress = |task: &str, part: f32| {
        if task != "initial packing" {
            parts.lock().unwrap().push(part);
        }
    };
    Simulation::prepare(&scene, executor, &progress).unwrap();
    let parts = parts.into_inner().unwrap();
    assert_eq!(parts.last(), Some(&1.0));
    // Control: there are several parts, and only the last is complete.
    assert!(parts.len() > 2 && parts[..parts.len() - 1].iter().all(|part| *part < 1.0), "{parts:?}");
}
