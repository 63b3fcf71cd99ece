//! Meshes and initial states shared by the cases.

use std::path::{Path, PathBuf};

use glam::{Quat, Vec3};
use splashdown::scene::{Body, BoundaryKind, MeshShape, MeshSource, Motion, Scene, UpAxis};
use splashdown::{Device, Simulation};
use splashdown_io::Mesh;

/// A body with the mesh of a file or a model, at a position.
pub fn body(name: &str, shape: MeshShape, scale: f32, position: Vec3, motion: Motion) -> Body {
    Body {
        name: name.into(),
        mesh: MeshSource { shape, scale, up: UpAxis::Y, position, rotation: Quat::IDENTITY },
        motion,
        friction: 0.0,
        adhesion: 0.0,
        boundary: BoundaryKind::Map,
        half_thickness: None,
        shell: None,
        colour: None,
    }
}

/// The eight corners of a box, x fastest.
fn corners(min: Vec3, max: Vec3) -> [[f32; 3]; 8] {
    std::array::from_fn(|k| {
        let pick = |axis: usize| if k >> axis & 1 == 0 { min[axis] } else { max[axis] };
        [pick(0), pick(1), pick(2)]
    })
}

/// The outward faces of a box, without the one with this index in [-x, +x, -y, +y, -z, +z].
fn faces(first: u32, without: Option<usize>) -> Vec<[u32; 3]> {
    let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let kept = quads.iter().enumerate().filter(|(face, _)| Some(*face) != without);
    kept.flat_map(|(_, [a, b, c, d])| [[*a, *b, *c], [*a, *c, *d]])
        .map(|triangle| triangle.map(|corner: u32| first + corner))
        .collect()
}

/// A box with sharp edges.
pub fn cuboid(min: Vec3, max: Vec3) -> Mesh {
    Mesh::new(corners(min, max).to_vec(), faces(0, None))
}

/// A tank with walls of this thickness around an inner box, open at the top.
pub fn tub(min: Vec3, max: Vec3, wall: f32) -> Mesh {
    let outer = corners(min - Vec3::splat(wall), max.with_x(max.x + wall).with_z(max.z + wall));
    let vertices = [outer, corners(min, max)].concat();
    let mut triangles = faces(0, Some(3));
    // The inner faces have the opposite orientation.
    triangles.extend(faces(8, Some(3)).iter().map(|&[a, b, c]| [a, c, b]));
    // The rim connects the upper corners of both boxes.
    let ring = [2, 6, 7, 3];
    for k in 0..4 {
        let (a, b) = (ring[k], ring[(k + 1) % 4]);
        triangles.extend([[a, b, b + 8], [a, b + 8, a + 8]]);
    }
    Mesh::new(vertices, triangles)
}

/// Writes a mesh for a scene to read.
pub fn file(folder: &Path, name: &str, mesh: &Mesh) -> MeshShape {
    assert!(mesh.topology().unwrap().is_watertight(), "{name}");
    let path: PathBuf = folder.join(name);
    splashdown_io::write_mesh(&path, mesh).unwrap();
    MeshShape::File(path)
}

/// The fluid of a scene with the densities of water at rest, where the level is `height(x)` in m above each particle.
pub fn at_rest(scene: &Scene, height: impl Fn(Vec3) -> f32) -> Simulation {
    let mut simulation = Simulation::new(scene, &Device::Cpu).unwrap();
    let mut particles = simulation.particles().unwrap();
    let params = *simulation.params();
    let per_depth = scene.gravity.length() / params.sound_speed.powi(2);
    let density = |x: &[f32; 3]| params.rest_density * (1.0 + per_depth * height(Vec3::from(*x)).max(0.0));
    particles.densities = particles.positions.iter().map(density).collect();
    Simulation::with_particles(scene, splashdown_gpu::CpuExecutor::new().into(), &particles).unwrap()
}
