//! Measures how long writing and reading a frame takes:
//! `cargo run --release -p splashdown-io --example write_speed [FOLDER]`.
//!
//! 65,536 particles as PLY and VTU, a mesh of 300,000 triangles as PLY and OBJ, its topology, and a picture of
//! 1280 x 720 pixels as PNG; the best and the median of 15 runs each. Files are flushed to the disk, except in the lines `no sync`.

use std::error::Error;
use std::io::{Write, stdout};
use std::path::PathBuf;
use std::time::Instant;

use splashdown_io::{
    Mesh, Particles, Picture, atomic, picture, prepare_folder, read_mesh, read_particles, write_mesh,
    write_particles,
};

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args_os()
        .nth(1)
        .map_or_else(|| std::env::temp_dir().join("splashdown-speed"), PathBuf::from);
    prepare_folder(&folder)?;
    let (particles, mesh, picture) = (particles_of(1 << 16), torus(500, 300), picture_of(1280, 720));
    for name in ["particles.ply", "particles.vtu"] {
        let path = folder.join(name);
        measure(name, || Ok(write_particles(&path, &particles)?))?;
        atomic::set_sync(false);
        measure("  no sync", || Ok(write_particles(&path, &particles)?))?;
        atomic::set_sync(true);
        measure("  read", || {
            read_particles(&path)?;
            Ok(path.metadata()?.len())
        })?;
    }
    for name in ["mesh.ply", "mesh.obj"] {
        let path = folder.join(name);
        measure(name, || Ok(write_mesh(&path, &mesh)?))?;
        atomic::set_sync(false);
        measure("  no sync", || Ok(write_mesh(&path, &mesh)?))?;
        atomic::set_sync(true);
        measure("  read", || {
            read_mesh(&path)?;
            Ok(path.metadata()?.len())
        })?;
    }
    measure("picture.png", || Ok(picture::write_png(&folder.join("picture.png"), &picture)?))?;
    measure("(topology)", || Ok(mesh.topology()?.edges as u64 * 8))?;
    measure("(volume)", || Ok(mesh.volume().to_bits() & 1))?;
    Ok(())
}

fn measure(name: &str, mut run: impl FnMut() -> Result<u64, Box<dyn Error>>) -> Result<(), Box<dyn Error>> {
    let (mut times, mut bytes) = (Vec::new(), 0);
    for _ in 0..15 {
        let start = Instant::now();
        bytes = run()?;
        times.push(start.elapsed().as_secs_f64() * 1e3);
    }
    times.sort_by(f64::total_cmp);
    let megabytes = bytes as f64 / 1e6;
    writeln!(stdout(), "{name:14} best {:7.2} ms, median {:7.2} ms, {megabytes:6.2} MB", times[0], times[7])?;
    Ok(())
}

/// Numbers with all digits, as in a simulation.
fn value(n: usize, salt: usize) -> f32 {
    ((n * 31 + salt) as f32 * 0.1).sin()
}

fn particles_of(count: usize) -> Particles {
    let vectors = |salt| (0..count).map(|n| std::array::from_fn(|axis| value(n, salt + axis))).collect();
    Particles::from_positions(vectors(0))
        .with_ids((0..count as u32).collect())
        .with_velocities(vectors(3))
        .with_densities((0..count).map(|n| 1000.0 + value(n, 6)).collect())
        .with_pressures((0..count).map(|n| 1e4 * value(n, 7)).collect())
}

fn torus(rings: u32, sides: u32) -> Mesh {
    let mut mesh = Mesh::default();
    for (ring, side) in (0..rings).flat_map(|ring| (0..sides).map(move |side| (ring, side))) {
        let turn = |n: u32, of: u32| (n as f32 / of as f32 * std::f32::consts::TAU).sin_cos();
        let ((sin, cos), (up, out)) = (turn(ring, rings), turn(side, sides));
        mesh.vertices.push([(2.0 + 0.5 * out) * cos, 0.5 * up, (2.0 + 0.5 * out) * sin]);
        mesh.normals.push([out * cos, up, out * sin]);
        let at = |r: u32, s: u32| (r % rings) * sides + s % sides;
        let [a, b, c, d] = [at(ring, side), at(ring, side + 1), at(ring + 1, side + 1), at(ring + 1, side)];
        mesh.triangles.extend([[a, b, c], [a, c, d]]);
    }
    mesh
}

/// Smooth shading with some noise, similar to a rendered surface.
fn picture_of(width: u32, height: u32) -> Picture {
    let mut rgba = Vec::new();
    for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
        let noise = ((x * 7919) ^ (y * 104_729)) % 5;
        rgba.extend([x / 8 + noise, y / 4 + noise, (x + y) / 12 + noise, 255].map(|channel| channel as u8));
    }
    Picture { width, height, rgba }
}
