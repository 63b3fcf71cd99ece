//! Whole runs with meshes that are not part of the project: closed, open and severely damaged ones.

use std::path::PathBuf;

use glam::Vec3;
use splashdown::scene::{MeshShape, Motion, Shape};
use splashdown::{Device, Simulation};

use crate::{body, tank};

#[test]
fn water_flows_around_every_shared_mesh() {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/meshes");
    for name in [
        "spot.obj",
        "spot_ugly.obj",
        "penguin.obj",
        "plane_holes.obj",
        "cube_no_bottom.obj",
        "BoxOpenedHole.obj",
    ] {
        let path = folder.join(name);
        if !path.exists() {
            eprintln!("SKIPPED: {name} does not exist");
            continue;
        }
        let mesh = splashdown_io::read_mesh(&path).unwrap();
        let corners = mesh.vertices.iter().map(|v| Vec3::from(*v));
        let (low, high) = corners.fold((Vec3::MAX, Vec3::MIN), |(low, high), v| (low.min(v), high.max(v)));
        // A third of a metre wide, on the floor in front of a dam break.
        let scale = 0.3 / (high - low).max_element();
        let mut scene = tank(0.03, [1.2, 0.6, 0.45], 0.3);
        if let Shape::Box { size, .. } = &mut scene.fluid.blocks[0].shape {
            size.x = 0.42;
        }
        let middle = 0.5 * (low + high) * scale;
        let place = Vec3::new(0.75, 0.01 - low.y * scale, 0.225) - middle.with_y(0.0);
        let mut obstacle = body("obstacle", "cube", scale, place, Motion::Static);
        obstacle.mesh.shape = MeshShape::File(path);
        scene.bodies.push(obstacle);
        let mut simulation = Simulation::new(&scene, &Device::Cpu).unwrap();
        let mut pushed = 0.0f32;
        for _ in 0..6 {
            let stats = simulation.advance(0.1).unwrap();
            let particles = simulation.particles().unwrap();
            assert_eq!(simulation.inside_bodies(&particles).unwrap(), 0, "{name} at {} s", stats.time);
            assert_eq!((stats.wall_corrections, stats.non_finite), (0, 0), "{name}: {stats:?}");
            pushed = pushed.max(simulation.body_states().unwrap()[0].force.length());
        }
        // Control: the water reached the obstacle. A thin plane along the flow is pushed by 0.2 N, the others by more than 1 N.
        assert!(pushed > 0.1, "{name}: {pushed} N");
        let beyond = simulation.particles().unwrap().positions.iter().filter(|x| x[0] > place.x).count();
        assert!(beyond > 50, "{name}: {beyond} particles beyond the middle of the obstacle");
    }
}
