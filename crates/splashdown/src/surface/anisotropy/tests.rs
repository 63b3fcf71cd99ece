//! Properties of the anisotropic surface of known shapes, with the isotropic surface as negative control. Lengths in spacings.

use glam::Vec3;
use splashdown_gpu::{CpuExecutor, Executor, testing};
use splashdown_io::Mesh;

use crate::scene::SurfaceKernels::{self, Anisotropic, Isotropic};
use crate::surface::{SurfaceParams, Walls, reconstruct_with};

fn params(kernels: SurfaceKernels) -> SurfaceParams {
    SurfaceParams { kernels, ..SurfaceParams::new(1.0) }
}

fn mesh_with(points: &[[f32; 3]], params: &SurfaceParams) -> Mesh {
    let mut executor = Executor::from(CpuExecutor::new());
    executor.poison();
    let mesh = reconstruct_with(points, params, &mut executor).unwrap().0;
    let topology = mesh.topology().unwrap();
    assert!(topology.is_watertight(), "{topology}");
    assert!(mesh.vertices.iter().chain(&mesh.normals).flatten().all(|x| x.is_finite()));
    mesh
}

fn mesh(points: &[[f32; 3]], kernels: SurfaceKernels) -> Mesh {
    mesh_with(points, &params(kernels))
}

/// The centres of a lattice of cells with one corner at the origin.
fn lattice(cells: [u32; 3], spacing: Vec3) -> Vec<Vec3> {
    let [x, y, z] = cells;
    (0..x * y * z)
        .map(|i| spacing * (Vec3::new((i % x) as f32, (i / x % y) as f32, (i / x / y) as f32) + 0.5))
        .collect()
}

/// Moves every coordinate by up to `most`.
fn jittered(points: &[Vec3], most: f32) -> Vec<[f32; 3]> {
    let unit = |i: u32| testing::noise(i) as f32 / u32::MAX as f32 * 2.0 - 1.0;
    let moved = |(i, p): (usize, &Vec3)| {
        let i = 3 * i as u32;
        (*p + most * Vec3::new(unit(i), unit(i + 1), unit(i + 2))).to_array()
    };
    points.iter().enumerate().map(moved).collect()
}

fn turned(points: &[Vec3]) -> Vec<[f32; 3]> {
    let turn = glam::Quat::from_scaled_axis(Vec3::new(0.4, 0.7, -0.2));
    points.iter().map(|&p| (turn * p).to_array()).collect()
}

/// Particles of a jet that falls and is stretched along z: little more than half of the density, in layers that are
/// turned against one another.
fn stretched_jet() -> Vec<[f32; 3]> {
    let layers = (0..24).flat_map(|layer| {
        let turn = glam::Quat::from_rotation_z(0.7 * layer as f32);
        let disc = lattice([8, 8, 1], Vec3::ONE).into_iter().map(|p| p - Vec3::new(4.0, 4.0, 0.5));
        let disc = disc.filter(|p| p.length() < 3.6);
        disc.map(move |p| turn * p + 1.7 * layer as f32 * Vec3::Z).collect::<Vec<_>>()
    });
    jittered(&layers.collect::<Vec<_>>(), 0.05)
}

/// The standard deviation of the distance of the vertices from the axis of the jet, away from its ends.
fn ripple(kernels: SurfaceKernels) -> f32 {
    let mesh = mesh(&stretched_jet(), kernels);
    let inner = mesh.vertices.iter().filter(|x| (6.0..34.0).contains(&x[2]));
    let radii: Vec<f32> = inner.map(|x| x[0].hypot(x[1])).collect();
    let mean = radii.iter().sum::<f32>() / radii.len() as f32;
    (radii.iter().map(|r| (r - mean) * (r - mean)).sum::<f32>() / radii.len() as f32).sqrt()
}

#[test]
fn a_stretched_jet_is_a_smooth_column() {
    let (smooth, rippled) = (ripple(Anisotropic), ripple(Isotropic));
    assert!(smooth < 0.5 * rippled && smooth < 0.15, "{smooth} and {rippled}");
}

/// The tilt of the free surface in degrees (root of the mean square), and the largest deviation from its level.
fn roughness(kernels: SurfaceKernels, jitter: f32) -> [f32; 2] {
    let walls = Walls::new([0.0; 3], [16.0; 3], [[true, true], [true, false], [true, true]]);
    let water = jittered(&lattice([16, 8, 16], Vec3::ONE), jitter);
    let mesh = mesh_with(&water, &SurfaceParams { walls, ..params(kernels) });
    let volume = mesh.volume() / 2048.0;
    assert!((volume - 1.0).abs() < 0.01, "{kernels}: {volume}");
    // The mesh ends on the walls, exactly.
    let [low, high] = mesh
        .vertices
        .iter()
        .fold([Vec3::MAX, Vec3::MIN], |[low, high], &x| [low.min(x.into()), high.max(x.into())]);
    assert_eq!((low, high.x, high.z), (Vec3::ZERO, 16.0, 16.0));
    let free = |x: &[f32; 3]| x[1] > 4.0 && x[0].min(x[2]) > 0.01 && x[0].max(x[2]) < 15.99;
    let pairs = mesh.vertices.iter().zip(&mesh.normals).filter(|(x, _)| free(x));
    let (mut count, mut square, mut deviation) = (0.0, 0.0_f32, 0.0_f32);
    for (x, n) in pairs {
        count += 1.0;
        square += n[1].min(1.0).acos().to_degrees().powi(2);
        deviation = deviation.max((x[1] - 8.0).abs());
    }
    assert!(count > 500.0);
    [(square / count).sqrt(), deviation]
}

#[test]
fn still_water_is_flat_and_keeps_its_level() {
    // A column of water that has come to rest has deviations of about a hundredth of a spacing.
    let [tilt, deviation] = roughness(Anisotropic, 0.024);
    assert!(tilt < 1.0 && deviation < 0.05, "{tilt} {deviation}");
    let [control, _] = roughness(Isotropic, 0.024);
    assert!(control > 1.1, "{control}");
}

#[test]
fn a_lone_particle_is_a_drop_of_its_own_volume_at_any_cell_size() {
    let drops = jittered(&lattice([5, 5, 5], Vec3::splat(8.13)), 1.0);
    let volume = |kernels, cell_size| {
        let mesh = mesh_with(&drops, &SurfaceParams { cell_size, ..params(kernels) });
        assert_eq!(mesh.topology().unwrap().components, drops.len());
        mesh.volume() / drops.len() as f64
    };
    for cell_size in [0.25, 0.5, 0.7] {
        let found = volume(Anisotropic, cell_size);
        assert!((found - 1.0).abs() < 0.03, "{cell_size}: {found}");
    }
    let control = volume(Isotropic, 0.5);
    assert!(control < 0.7, "{control}");
}

#[test]
fn films_have_no_holes_and_keep_their_volume() {
    for (layers, tolerance) in [(1, 0.05), (2, 0.03), (3, 0.03)] {
        let film = jittered(&lattice([20, layers, 20], Vec3::ONE), 0.15);
        let mesh = mesh(&film, Anisotropic);
        let volume = mesh.volume() / film.len() as f64;
        assert!((volume - 1.0).abs() < tolerance, "{layers}: {volume}");
        assert_eq!(mesh.topology().unwrap().euler_characteristic, 2, "{layers}");
    }
    // Stretched to half of its density, without holes and without bubbles inside.
    for layers in [1, 2] {
        let film = jittered(&lattice([20, layers, 20], Vec3::new(1.45, 1.0, 1.45)), 0.2);
        let euler = |kernels| mesh(&film, kernels).topology().unwrap().euler_characteristic;
        assert_eq!(euler(Anisotropic), 2, "{layers}");
        if layers == 1 {
            assert!(euler(Isotropic) < 0, "{}", euler(Isotropic));
        }
    }
}

#[test]
fn compact_fluid_keeps_its_volume() {
    let ball: Vec<Vec3> =
        lattice([24; 3], Vec3::ONE).into_iter().map(|p| p - 12.03).filter(|p| p.length() < 9.0).collect();
    let volume = mesh(&jittered(&ball, 0.05), Anisotropic).volume() / ball.len() as f64;
    assert!((volume - 1.0).abs() < 0.02, "{volume}");
    let block = jittered(&lattice([14; 3], Vec3::ONE), 0.05);
    let volume = mesh(&block, Anisotropic).volume() / block.len() as f64;
    assert!((volume - 1.0).abs() < 0.01, "{volume}");
}

#[test]
fn degenerate_arrangements_give_closed_meshes_and_equal_ones_equal_bits() {
    let line = lattice([30, 1, 1], Vec3::splat(0.4));
    let plane = lattice([12, 12, 1], Vec3::splat(0.3));
    let coincident = vec![Vec3::splat(0.37); 40];
    let two = vec![Vec3::ZERO, Vec3::new(0.0, 1e-6, 0.0)];
    let far = vec![Vec3::ZERO, Vec3::splat(1.99), Vec3::splat(300.0)];
    for points in [line, plane, coincident, two, far] {
        for points in [points.iter().map(|p| p.to_array()).collect(), turned(&points)] {
            for iso_level in [0.05, 0.6, 0.8] {
                let params = SurfaceParams { iso_level, ..params(Anisotropic) };
                let mesh = mesh_with(&points, &params);
                assert!(mesh.volume() > 0.0);
                assert_eq!(mesh, mesh_with(&points, &params));
            }
        }
    }
}
