//! Measures the construction of solids: a sphere with many triangles, and the same with floating fragments.
//!
//! `cargo run --release -p splashdown --example solid_times -- 100000`

use std::time::Instant;

use splashdown::boundary::{KernelPair, PlaneFraction};
use splashdown::solid::{Solid, SolidSettings};
use splashdown_io::Mesh;

/// A sphere of radius 1 m with about this number of triangles.
fn sphere(triangles: u32) -> Mesh {
    let rings = ((triangles / 4) as f64).sqrt().max(3.0) as u32;
    let round = 2 * rings;
    let mut mesh = Mesh::new(vec![[0.0, 1.0, 0.0], [0.0, -1.0, 0.0]], Vec::new());
    for ring in 1..rings {
        let (height, across) = (f64::from(ring) / f64::from(rings) * std::f64::consts::PI).sin_cos();
        for k in 0..round {
            let (s, c) = (f64::from(k) / f64::from(round) * std::f64::consts::TAU).sin_cos();
            mesh.vertices.push([height * c, across, height * s].map(|x| x as f32));
        }
    }
    let at = |ring: u32, k: u32| 2 + (ring - 1) * round + k % round;
    for k in 0..round {
        mesh.triangles.push([0, at(1, k + 1), at(1, k)]);
        mesh.triangles.push([1, at(rings - 1, k), at(rings - 1, k + 1)]);
        for ring in 1..rings - 1 {
            let (a, b, c, d) = (at(ring, k), at(ring, k + 1), at(ring + 1, k + 1), at(ring + 1, k));
            mesh.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    mesh
}

/// Small triangles on a lattice outside the sphere.
fn add_fragments(mesh: &mut Mesh, fragments: u32) {
    for k in 0..fragments {
        let corner = [k % 20, k / 20 % 20, k / 400].map(|n| 0.6 + 0.02 * n as f32);
        let first = mesh.vertices.len() as u32;
        for axis in 0..3 {
            let mut place = corner;
            place[axis] += 0.005;
            mesh.vertices.push(place);
        }
        mesh.triangles.push([first, first + 1, first + 2]);
    }
}

#[expect(clippy::print_stdout, reason = "an example that prints")]
fn main() {
    let triangles = std::env::args().nth(1).and_then(|text| text.parse().ok()).unwrap_or(100_000);
    let folder = std::env::temp_dir().join(format!("splashdown-solid-times-{}", std::process::id()));
    let settings = SolidSettings {
        cell_size: 0.02,
        support_radius: 0.08,
        fraction: PlaneFraction::of(KernelPair::WendlandC2),
        half_thickness: 0.02,
        shell: None,
        region: None,
        cache: Some(folder.clone()),
    };
    for fragments in [0, 2000] {
        let mut mesh = sphere(triangles);
        add_fragments(&mut mesh, fragments);
        for what in ["built", "from the cache"] {
            let begun = Instant::now();
            match Solid::build(&mesh, &settings, &|_| {}) {
                Ok(solid) => println!(
                    "{what}: {:.3} s, {} nodes, volume {:.5} m^3; {}",
                    begun.elapsed().as_secs_f64(),
                    solid.field.values.len(),
                    solid.mass.volume,
                    solid.report
                ),
                Err(error) => println!("{what}: {error}"),
            }
        }
    }
    // Best effort: the folder is temporary.
    std::fs::remove_dir_all(&folder).ok();
}
