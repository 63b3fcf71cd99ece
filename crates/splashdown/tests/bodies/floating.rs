use glam::{Quat, Vec3};
use splashdown::scene::Method;
use splashdown::{Device, Simulation};

use crate::{body, free, tank};

/// The draft of a floating cube of this density over its edge, and its tilt; means over the last third of two seconds.
fn draft(method: Method, density: f32) -> (f32, f32) {
    let (spacing, edge) = (0.02, 0.2);
    let mut scene = tank(spacing, [0.5, 0.5, 0.5], 0.24);
    scene.solver.select_method(method);
    // Starts near its floating position, so that it comes to rest quickly.
    let bottom = 0.24 - edge * density / 1000.0;
    scene.bodies.push(body(
        "float",
        "cube",
        edge,
        Vec3::new(0.25, bottom + 0.5 * edge + 0.01, 0.25),
        free(density),
    ));
    let mut simulation = Simulation::new(&scene, &Device::Cpu).unwrap();
    simulation.advance(1.4).unwrap();
    let (mut depth, mut tilt, mut samples) = (0.0, 0.0f32, 0);
    for _ in 0..12 {
        simulation.advance(0.05).unwrap();
        let state = simulation.body_states().unwrap()[0];
        let particles = simulation.particles().unwrap();
        // The water level beside the cube, from the particles of the highest layer.
        let mut heights: Vec<f32> = particles
            .positions
            .iter()
            .filter(|x| (x[0] - 0.25).abs().max((x[2] - 0.25).abs()) > 0.17)
            .map(|x| x[1])
            .collect();
        heights.sort_by(f32::total_cmp);
        let columns = (0.25 - 0.34f32 * 0.34) / (spacing * spacing);
        let top = &heights[heights.len() - columns as usize..];
        let level = top.iter().sum::<f32>() / top.len() as f32 + 0.5 * spacing;
        depth += (level - (state.position.y - 0.5 * edge)) / edge;
        tilt = tilt.max((state.orientation * Vec3::Y).angle_between(Vec3::Y));
        samples += 1;
    }
    (depth / samples as f32, tilt)
}

#[test]
fn the_draft_of_floating_cubes_follows_archimedes() {
    for (method, densities) in [(Method::Wcsph, [100.0, 300.0, 700.0]), (Method::Dfsph, [50.0, 300.0, 700.0])]
    {
        let depths = densities.map(|density| (density, draft(method, density)));
        eprintln!("{method}: {depths:?}");
        for (density, (depth, tilt)) in depths {
            // The water stays half a spacing away from the cube's faces, a twentieth of its edge at this resolution.
            assert!((depth - density / 1000.0).abs() < 0.08, "{method}, {density}: {depth}");
            // A homogeneous cube floats upright only below 0.211 and above 0.789 of the water's density; between these it
            // turns onto an edge or a corner (Gilbert 1991, American Mathematical Monthly 98, 201).
            if !(211.0..789.0).contains(&density) {
                assert!(tilt < 0.1, "{method}, {density}: {tilt}");
            }
        }
    }
}

#[test]
fn a_heavy_body_sinks_to_the_floor_and_comes_to_rest() {
    let mut scene = tank(0.025, [0.4, 0.4, 0.4], 0.2);
    scene.bodies.push(body("stone", "cube", 0.1, Vec3::new(0.2, 0.3, 0.2), free(2500.0)));
    scene.bodies[0].mesh.rotation = Quat::from_rotation_y(0.3);
    let mut simulation = Simulation::new(&scene, &Device::Cpu).unwrap();
    simulation.advance(1.2).unwrap();
    let state = simulation.body_states().unwrap()[0];
    assert!((state.position.y - 0.05).abs() < 0.006, "{state:?}");
    assert!(state.velocity.length() < 0.05, "{state:?}");
}
