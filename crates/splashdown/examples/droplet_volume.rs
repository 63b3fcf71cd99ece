//! The volume of surface and droplets compared with that of the particles, with and without separation of isolated
//! particles: `cargo run --release -p splashdown --example droplet_volume -- SCENE.toml out/NAME/particles/particles_*.ply`.

use std::time::Instant;

use splashdown::surface::{SurfaceParams, Walls, isolated, reconstruct_with};
use splashdown::{Device, Scene};
use splashdown_io::{Particles, read_particles};

#[expect(clippy::print_stdout, reason = "an example that prints")]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let scene = Scene::load(&arguments.next().ok_or("usage: droplet_volume SCENE.toml FILE...")?)?;
    let spacing = scene.fluid.particle_spacing;
    let of_scene = SurfaceParams::of_scene(&scene.surface, spacing, Walls::of_domain(&scene.domain));
    let files = arguments.map(|path| read_particles(path.as_ref())).collect::<Result<Vec<Particles>, _>>()?;
    let mut executor = Device::Cpu.executor()?;
    let particle = f64::from(spacing).powi(3);
    println!("| min_blob | min_neighbours | droplets | mesh | mesh and droplets | components | time |");
    println!("|---|---|---|---|---|---|---|");
    for (min_blob, min_neighbours) in
        [(0, 0), (2, 0), (9, 0), (0, 3), (5, 3), (9, 2), (9, 3), (16, 3), (32, 3), (9, 4)]
    {
        let mut params = of_scene;
        (params.min_blob, params.min_neighbours) = (min_blob, min_neighbours);
        let (mut droplets, mut mesh_volume, mut all, mut components, mut time) =
            (0, 0.0, 0.0, 0, f64::INFINITY);
        for particles in &files {
            let begun = Instant::now();
            let (mesh, stats) = reconstruct_with(&particles.positions, &params, &mut executor)?;
            time = time.min(begun.elapsed().as_secs_f64());
            assert_eq!(stats.droplets as usize, isolated(&particles.positions, &params)?.len());
            droplets += stats.droplets;
            mesh_volume += mesh.volume();
            all += particles.len() as f64 * particle;
            components += mesh.topology()?.components;
        }
        println!(
            "| {min_blob} | {min_neighbours} | {droplets} | {:.4} | {:.4} | {components} | {:.1} ms |",
            mesh_volume / all,
            (mesh_volume + f64::from(droplets) * particle) / all,
            1e3 * time,
        );
    }
    Ok(())
}
