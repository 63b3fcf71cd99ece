//! Simulates a collapsing column of water and reads the particles as arrays.
//!
//! `cargo run --release -p splashdown --example simulate`

#![expect(clippy::print_stdout, reason = "an example prints its results")]

use splashdown::{Device, Scene, Simulation};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let scene = Scene::builder("column", 0.5)
        .domain([0.0, 0.0, 0.0], [1.6, 1.0, 0.5])
        .particle_spacing(0.04)
        .block([0.0, 0.0, 0.0], [0.4, 0.6, 0.5])
        .build()?;
    // The best GPU; the CPU where there is none.
    let mut simulation = Simulation::new(&scene, &Device::Auto)?;
    for _ in 0..5 {
        let stats = simulation.advance(0.1)?; // seconds, in as many steps as stability requires
        let particles = simulation.particles()?;
        let positions: &[[f32; 3]] = &particles.positions; // m
        let velocities: &[[f32; 3]] = &particles.velocities; // m/s
        let front = positions.iter().map(|x| x[0]).fold(0.0, f32::max);
        let fastest = velocities.iter().map(|v| v[0].hypot(v[1]).hypot(v[2])).fold(0.0, f32::max);
        println!("{:.1} s: front at {front:.3} m, fastest particle {fastest:.2} m/s", stats.time);
    }
    Ok(())
}
