//! Meshes and particles shared by several tests.
#![expect(dead_code, reason = "each test binary uses its own part of these helpers")]

pub mod gltf_files;

use std::path::{Path, PathBuf};

use splashdown_io::{Mesh, Particles};

/// A cube with its lower corner at `corner`, oriented outwards.
pub fn cube(corner: [f32; 3], size: f32) -> Mesh {
    let vertices = (0..8)
        .map(|n| std::array::from_fn(|axis| corner[axis] + if n >> axis & 1 == 1 { size } else { 0.0 }))
        .collect();
    let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let triangles = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    Mesh::new(vertices, triangles)
}

/// A surface of revolution on a `rings` x `sides` grid that closes in both directions: a torus around y.
pub fn torus(radius: f32, tube: f32, rings: u32, sides: u32) -> Mesh {
    let mut mesh = Mesh::default();
    for ring in 0..rings {
        let (sin, cos) = (ring as f32 / rings as f32 * std::f32::consts::TAU).sin_cos();
        for side in 0..sides {
            let (up, out) = (side as f32 / sides as f32 * std::f32::consts::TAU).sin_cos();
            let distance = radius + tube * out;
            mesh.vertices.push([distance * cos, tube * up, distance * sin]);
            mesh.normals.push([out * cos, up, out * sin]);
            let at = |r: u32, s: u32| (r % rings) * sides + s % sides;
            let [a, b, c, d] =
                [at(ring, side), at(ring, side + 1), at(ring + 1, side + 1), at(ring + 1, side)];
            mesh.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    mesh
}

/// Both meshes in one, without shared vertices.
pub fn joined(mut first: Mesh, second: &Mesh) -> Mesh {
    let shift = first.vertices.len() as u32;
    first.vertices.extend(&second.vertices);
    first.triangles.extend(second.triangles.iter().map(|t| t.map(|index| index + shift)));
    first
}

/// Particles with every attribute and distinct values.
pub fn particles(count: usize) -> Particles {
    let value = |n: usize, salt: usize| ((n * 31 + salt) as f32).sin();
    Particles::from_positions((0..count).map(|n| std::array::from_fn(|axis| value(n, axis))).collect())
        .with_ids((0..count as u32).map(|n| n.wrapping_mul(2_654_435_761)).collect())
        .with_velocities((0..count).map(|n| std::array::from_fn(|axis| value(n, axis + 3) * 9.0)).collect())
        .with_densities((0..count).map(|n| 1000.0 + value(n, 6)).collect())
        .with_pressures((0..count).map(|n| 1e4 * value(n, 7)).collect())
}

/// A file of the shared test data, or `None` with a message if it is missing.
pub fn shared_data(name: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data").join(name);
    if path.exists() {
        return Some(path);
    }
    eprintln!("SKIPPED: the shared test data `{name}` is missing");
    None
}

/// The sorted names in a folder, including hidden files.
pub fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).expect("the test's folder exists");
    let mut names: Vec<_> =
        entries.map(|entry| entry.expect("readable").file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}
