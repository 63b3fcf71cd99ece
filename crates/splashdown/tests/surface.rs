//! Properties of the surface mesh for arbitrary particles, and for particles with a known surface.

use std::path::Path;

use glam::Vec3;
use proptest::prelude::*;
use splashdown::cells::Grid;
use splashdown::scene::SurfaceKernels;
use splashdown::surface::{
    self, Surface, SurfaceError, SurfaceInput, SurfaceParams, SurfaceStats, reconstruct_with,
};
use splashdown_gpu::{CpuExecutor, Executor, testing};
use splashdown_io::Mesh;

const SPACING: f32 = 0.05;

fn cpu() -> Executor {
    let mut executor = Executor::from(CpuExecutor::new());
    executor.poison();
    executor
}

/// Lattice points in a ball.
fn ball(center: Vec3, radius: f32) -> Vec<[f32; 3]> {
    let n = (radius / SPACING).ceil() as i32;
    let lattice = (-n..=n).flat_map(|x| (-n..=n).flat_map(move |y| (-n..=n).map(move |z| [x, y, z])));
    let points = lattice.map(|p| SPACING * Vec3::from(p.map(|c| c as f32)));
    points.filter(|p| p.length() <= radius).map(|p| (center + p).to_array()).collect()
}

/// Asserts that a mesh is closed, manifold and oriented outwards, with unit normals that point to
/// the outer side of the triangles.
fn assert_sound(mesh: &Mesh, stats: &SurfaceStats) {
    mesh.check().unwrap();
    let topology = mesh.topology().unwrap();
    assert!(topology.is_watertight(), "{topology}");
    assert_eq!(topology.unused_vertices, 0);
    assert_eq!(
        (mesh.vertices.len(), mesh.triangles.len()),
        (stats.vertices as usize, stats.triangles as usize)
    );
    assert!(mesh.vertices.iter().flatten().all(|x| x.is_finite()));
    assert!(mesh.is_empty() || mesh.volume() > 0.0, "volume {}", mesh.volume());
    assert!(mesh.normals.iter().all(|&n| (Vec3::from(n).length() - 1.0).abs() < 1e-4));
}

#[test]
fn declarations_agree_with_the_wgsl() {
    let sources = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/src/surface"));
    let wrong = testing::gate(sources, &surface::passes());
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn the_surface_of_a_ball_is_a_sphere_of_equal_volume() {
    for (name, mut executor) in testing::executors("the_surface_of_a_ball_is_a_sphere_of_equal_volume") {
        for smoothing_iterations in [0, 20] {
            let points = ball(Vec3::new(0.3, -0.2, 7.0), 0.5);
            let params = {
                let mut params = SurfaceParams::new(SPACING);
                params.smoothing_iterations = smoothing_iterations;
                params
            };
            let (mesh, stats) = reconstruct_with(&points, &params, &mut executor).unwrap();
            assert_sound(&mesh, &stats);
            let topology = mesh.topology().unwrap();
            assert_eq!(topology.euler_characteristic, 2, "{name}: {topology}");
            assert_eq!(stats.not_finite, 0);
            // The iso level 0.6 is slightly inside the outer faces of the particles, and marching
            // cubes and smoothing cut convex corners: a twentieth of a spacing everywhere, which is
            // 3 * 0.05 / 10 of the volume, plus the roughness of the lattice.
            let expected = points.len() as f64 * f64::from(SPACING).powi(3);
            let ratio = mesh.volume() / expected;
            assert!((0.93..1.03).contains(&ratio), "{name}, {smoothing_iterations}: {ratio}");
            for (vertex, normal) in mesh.vertices.iter().zip(&mesh.normals) {
                let outwards = (Vec3::from(*vertex) - Vec3::new(0.3, -0.2, 7.0)).normalize_or_zero();
                assert!(outwards.dot(Vec3::from(*normal)) > 0.6, "{name}: {vertex:?} {normal:?}");
            }
        }
    }
}

#[test]
fn smoothing_removes_the_bumps_of_particles() {
    let mut executor = cpu();
    let center = Vec3::ZERO;
    let mut points = ball(center, 0.5);
    for (i, p) in points.iter_mut().flatten().enumerate() {
        *p += 0.2 * SPACING * (testing::noise(i as u32) as f32 / u32::MAX as f32 - 0.5);
    }
    let roughness = |smoothing_iterations, executor: &mut Executor| {
        let params = {
            let mut params = SurfaceParams::new(SPACING);
            params.smoothing_iterations = smoothing_iterations;
            params
        };
        let (mesh, _) = reconstruct_with(&points, &params, executor).unwrap();
        // The mean angle between the normals of adjacent triangles.
        let normal = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|v| Vec3::from(mesh.vertices[v as usize]));
            (b - a).cross(c - a).normalize_or_zero()
        };
        let error = mesh
            .triangles
            .iter()
            .map(|t| 1.0 - normal(t).dot(Vec3::from(mesh.vertices[t[0] as usize]).normalize_or_zero()));
        error.sum::<f32>() / mesh.triangles.len() as f32
    };
    let (rough, smooth) = (roughness(0, &mut executor), roughness(25, &mut executor));
    assert!(smooth < 0.5 * rough, "{rough} -> {smooth}");
}

#[test]
fn two_drops_are_two_components() {
    let mut points = ball(Vec3::ZERO, 0.15);
    points.extend(ball(Vec3::new(0.6, 0.1, 0.0), 0.2));
    let (mesh, stats) = reconstruct_with(&points, &SurfaceParams::new(SPACING), &mut cpu()).unwrap();
    assert_sound(&mesh, &stats);
    let topology = mesh.topology().unwrap();
    assert_eq!((topology.components, topology.euler_characteristic), (2, 4), "{topology}");
}

#[test]
fn no_particles_give_an_empty_mesh_and_non_finite_ones_are_counted() {
    for (_, mut executor) in
        testing::executors("no_particles_give_an_empty_mesh_and_non_finite_ones_are_counted")
    {
        let params = SurfaceParams::new(SPACING);
        let (mesh, stats) = reconstruct_with(&[], &params, &mut executor).unwrap();
        assert!(mesh.is_empty() && mesh.vertices.is_empty() && stats == SurfaceStats::default());
        let bad = [[f32::NAN, 0.0, 0.0], [0.0, f32::INFINITY, 0.0]];
        let (mesh, stats) = reconstruct_with(&bad, &params, &mut executor).unwrap();
        assert!(mesh.is_empty() && stats.not_finite == 2);
        let mixed = [bad[0], [0.1, 0.2, 0.3], bad[1]];
        let (mesh, stats) = reconstruct_with(&mixed, &params, &mut executor).unwrap();
        assert_sound(&mesh, &stats);
        assert_eq!((mesh.topology().unwrap().components, stats.not_finite), (1, 2));
    }
}

#[test]
fn invalid_parameters_and_too_large_regions_are_rejected() {
    let good = SurfaceParams::new(SPACING);
    let refused = |params: &SurfaceParams, points: &[[f32; 3]]| {
        reconstruct_with(points, params, &mut cpu()).unwrap_err()
    };
    for value in [0.0, -1.0, f32::NAN, f32::INFINITY, 1e-30] {
        for params in [
            {
                let mut params = good;
                params.cell_size = value;
                params
            },
            {
                let mut params = good;
                params.support_radius = value;
                params
            },
            {
                let mut params = good;
                params.particle_spacing = value;
                params
            },
            {
                let mut params = good;
                params.iso_level = value;
                params
            },
        ] {
            let error = refused(&params, &[[0.0; 3]]);
            assert!(matches!(error, SurfaceError::Parameter { .. }), "{error}");
            assert!(error.to_string().contains("must be"), "{error}");
        }
    }
    let far = refused(&good, &[[0.0; 3], [1e30; 3]]);
    assert!(matches!(far, SurfaceError::TooFar { .. }), "{far}");
    let farther = refused(&good, &[[-3e38; 3], [3e38; 3]]);
    assert!(matches!(farther, SurfaceError::TooFar { .. }), "{farther}");
    let spread = refused(&good, &[[0.0; 3], [5000.0; 3]]);
    assert!(matches!(spread, SurfaceError::TooLarge { .. }), "{spread}");
}

/// Particle distributions that are difficult for surface extraction: random, coincident, on the
/// borders of cells and blocks.
fn clouds() -> impl Strategy<Value = Vec<[f32; 3]>> {
    let random = prop::collection::vec(prop::array::uniform3(-0.5_f32..0.5), 1..120);
    let on_nodes = prop::collection::vec(prop::array::uniform3(-12_i32..12), 1..120)
        .prop_map(|points| points.into_iter().map(|p| p.map(|c| 0.025 * c as f32)).collect());
    let on_blocks = prop::collection::vec(prop::array::uniform3(-3_i32..3), 1..40)
        .prop_map(|points| points.into_iter().map(|p| p.map(|c| 0.2 * c as f32)).collect());
    let in_one_place = (prop::array::uniform3(-5.0_f32..5.0), 1..40_usize).prop_map(|(p, n)| vec![p; n]);
    let base = prop_oneof![4 => random, 2 => on_nodes, 1 => on_blocks, 1 => in_one_place];
    // Some particles are duplicated.
    (base, 0..20_usize).prop_map(|(mut points, twice): (Vec<[f32; 3]>, usize)| {
        points.extend_from_within(..twice.min(points.len()));
        points
    })
}

fn parameters() -> impl Strategy<Value = SurfaceParams> {
    // Cells from a quarter of a spacing to more than the support radius; iso levels over the whole
    // range of the field.
    (0.25_f32..3.0, 1.2_f32..3.0, 0.02_f32..1.1, 0..4_u32, any::<bool>()).prop_map(
        |(cell, support, iso_level, smoothing_iterations, is_anisotropic)| {
            let mut params = SurfaceParams::new(SPACING);
            if is_anisotropic {
                params.kernels = SurfaceKernels::Anisotropic;
            }
            params.cell_size = cell * SPACING;
            params.support_radius = support * SPACING;
            params.iso_level = iso_level;
            params.smoothing_iterations = smoothing_iterations;
            params
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_particles_give_a_closed_manifold_oriented_mesh(points in clouds(), params in parameters()) {
        let (mesh, stats) = match reconstruct_with(&points, &params, &mut cpu()) {
            // Coarse cells miss single particles, and not every distribution reaches the highest
            // levels.
            Err(SurfaceError::NoSurface { given, highest }) => {
                prop_assert!(given == params.iso_level && (0.0..given).contains(&highest), "{highest}");
                return Ok(());
            }
            outcome => outcome.unwrap(),
        };
        mesh.check().unwrap();
        prop_assert!(!mesh.is_empty());
        let topology = mesh.topology().unwrap();
        prop_assert!(topology.is_watertight(), "{topology}");
        prop_assert_eq!(topology.unused_vertices, 0);
        prop_assert_eq!(stats.triangles as usize, mesh.triangles.len());
        prop_assert!(mesh.vertices.iter().chain(&mesh.normals).flatten().all(|x| x.is_finite()));
        // Smoothing can invert a component of two or three cells, marching cubes cannot.
        if params.smoothing_iterations == 0 {
            prop_assert!(mesh.volume() > 0.0);
        }
    }
}

#[test]
fn a_missing_and_a_flipped_triangle_are_detected() {
    let (mesh, _) =
        reconstruct_with(&ball(Vec3::ZERO, 0.2), &SurfaceParams::new(SPACING), &mut cpu()).unwrap();
    assert!(mesh.topology().unwrap().is_watertight());
    let mut holed = mesh.clone();
    holed.triangles.swap_remove(100);
    assert!(!holed.topology().unwrap().is_closed());
    let mut flipped = mesh.clone();
    flipped.triangles[100].swap(0, 1);
    assert!(!flipped.topology().unwrap().is_oriented());
    let mut doubled = mesh.clone();
    doubled.triangles.push(mesh.triangles[100]);
    assert!(!doubled.topology().unwrap().is_manifold());
}

/// One particle per cell of a row, in the layout of a simulation.
fn simulation_input(executor: &mut Executor, capacity: u32) -> SurfaceInput {
    let grid =
        Grid::new(Vec3::ZERO, Vec3::new(1.0, 0.2, 0.2), 2.0 * SPACING).unwrap().for_gpu(4096, u64::MAX);
    let mut particles: Vec<_> = (0..10)
        .flat_map(|i| [0.03, 0.07].map(|y| Vec3::new(0.05 + 0.1 * i as f32, y, 0.05).extend(f32::NAN)))
        .collect();
    particles.sort_by_key(|p| grid.cell_of(p.truncate()));
    let mut cell_start = vec![0_u32; grid.cell_count as usize + 1];
    for p in &particles {
        cell_start[grid.cell_of(p.truncate()) as usize + 1] += 1;
    }
    (1..cell_start.len()).for_each(|cell| cell_start[cell] += cell_start[cell - 1]);
    // Space for inactive particles with arbitrary contents.
    particles.resize(capacity as usize, glam::Vec4::NAN);
    SurfaceInput {
        sorted_positions: executor.create_from("sorted_positions", &particles).unwrap(),
        sorted_velocities: executor.create_from("sorted_velocities", &[]).unwrap(),
        sorted_ids: executor.create_from("sorted_ids", &[]).unwrap(),
        cell_start: executor.create_from("cell_start", &cell_start).unwrap(),
        grid: executor.create_uniform("grid", &grid).unwrap(),
        grid_host: grid,
        particle_capacity: capacity,
        solids: None,
    }
}

#[test]
fn an_exceeded_capacity_is_reported_and_enlarged() {
    for (name, mut executor) in testing::executors("an_exceeded_capacity_is_reported_and_enlarged") {
        for smoothing_iterations in [0, 5] {
            let params = {
                let mut params = SurfaceParams::new(SPACING);
                params.smoothing_iterations = smoothing_iterations;
                params
            };
            let input = simulation_input(&mut executor, 50);
            let mut roomy = Surface::new(&mut executor, params, input).unwrap();
            let stats = roomy.extract(&mut executor).unwrap();
            assert_eq!(stats.retries, 0);
            let mesh = roomy.mesh(&mut executor).unwrap();
            assert_sound(&mesh, &stats);
            for (blocks, vertices, triangles) in
                [(1, 1, 1), (stats.blocks, 10, 7), (stats.blocks, stats.vertices, 5), (3, 1 << 20, 1 << 20)]
            {
                let mut tight =
                    Surface::with_capacity(&mut executor, params, input, blocks, vertices, triangles)
                        .unwrap();
                let mut repeated = tight.extract(&mut executor).unwrap();
                assert!(repeated.retries > 0 && repeated.retries <= 3, "{name}: {repeated:?}");
                repeated.retries = 0;
                assert_eq!(repeated, stats, "{name}");
                assert_eq!(tight.mesh(&mut executor).unwrap(), mesh, "{name}");
                // The capacity does not shrink.
                assert_eq!(tight.extract(&mut executor).unwrap().retries, 0);
            }
        }
    }
}

/// The memory in use before a surface, and after each of ten surfaces that grow and are dropped.
fn bytes_of_recreations(executor: &mut Executor, free: bool) -> Vec<u64> {
    let input = simulation_input(executor, 50);
    let mut bytes = vec![executor.bytes()];
    for i in 0..10 {
        let mut params = SurfaceParams::new(SPACING);
        params.cell_size *= 1.0 - 0.05 * i as f32;
        params.smoothing_iterations = i % 3;
        let mut surface = Surface::with_capacity(executor, params, input, 1, 1, 1).unwrap();
        assert!(surface.extract(executor).unwrap().retries > 0);
        if free {
            surface.free(executor).unwrap();
        }
        bytes.push(executor.bytes());
    }
    bytes
}

#[test]
fn recreated_surfaces_do_not_accumulate_memory() {
    for (name, mut executor) in testing::executors("recreated_surfaces_do_not_accumulate_memory") {
        let bytes = bytes_of_recreations(&mut executor, true);
        assert!(bytes.iter().all(|&after| after == bytes[0]), "{name}: {bytes:?}");
        // Negative control: without `free` the memory grows.
        let bytes = bytes_of_recreations(&mut executor, false);
        assert!(bytes.is_sorted_by(|a, b| a < b), "{name}: {bytes:?}");
    }
}

#[test]
fn reconstruction_and_refused_surfaces_leave_no_buffers() {
    for (name, mut executor) in testing::executors("reconstruction_and_refused_surfaces_leave_no_buffers") {
        let mut params = SurfaceParams::new(SPACING);
        params.smoothing_iterations = 2;
        let points = ball(Vec3::ZERO, 0.2);
        let (mesh, _) = reconstruct_with(&points, &params, &mut executor).unwrap();
        assert!(!mesh.is_empty());
        assert_eq!(executor.bytes(), 0, "{name}");
        params.iso_level = 5.0;
        let error = reconstruct_with(&points, &params, &mut executor).unwrap_err();
        assert!(matches!(error, SurfaceError::NoSurface { .. }), "{name}: {error}");
        assert_eq!(executor.bytes(), 0, "{name}");
        let input = simulation_input(&mut executor, 50);
        let before = executor.bytes();
        let params = SurfaceParams::new(SPACING);
        let refused = Surface::with_capacity(&mut executor, params, input, 1, 1, u32::MAX);
        assert!(matches!(refused, Err(SurfaceError::Gpu(_))), "{name}");
        assert_eq!(executor.bytes(), before, "{name}");
    }
}

/// Without blocking, as in a window: the status arrives later and enlarges the buffers for the next
/// frame.
#[test]
fn extraction_without_blocking_writes_the_draw_arguments() {
    for (name, mut executor) in testing::executors("extraction_without_blocking_writes_the_draw_arguments") {
        let input = simulation_input(&mut executor, 20);
        let params = SurfaceParams::new(SPACING);
        let mut surface = Surface::with_capacity(&mut executor, params, input, 4, 8, 8).unwrap();
        let mut args = Vec::new();
        for _ in 0..5 {
            let mut frame = splashdown_gpu::Recording::new("frame");
            surface.record(&mut frame);
            executor.run(&frame).unwrap();
            let request = executor.request(surface.status(), 1).unwrap();
            args = executor.read(surface.draw_args()).unwrap();
            assert!(args[0] <= surface.indices().len(), "{name}");
            let status = request.wait().unwrap()[0];
            surface.grow(&mut executor, &status).unwrap();
        }
        let mesh = surface.mesh(&mut executor).unwrap();
        assert!(mesh.topology().unwrap().is_watertight());
        assert_eq!(args, [3 * mesh.triangles.len() as u32, 1, 0, 0, 0], "{name}");
    }
}

#[test]
fn a_grid_finer_than_the_kernel_is_rejected() {
    let mut executor = cpu();
    let input = simulation_input(&mut executor, 20);
    let params = {
        let mut params = SurfaceParams::new(SPACING);
        params.support_radius = 0.2;
        params
    };
    let error = Surface::new(&mut executor, params, input).unwrap_err();
    assert!(matches!(error, SurfaceError::GridTooFine { .. }), "{error}");
}

#[test]
fn meshes_are_bit_identical_for_any_number_of_threads() {
    let mut points = ball(Vec3::ZERO, 0.4);
    for (i, p) in points.iter_mut().flatten().enumerate() {
        *p += 0.3 * SPACING * (testing::noise(i as u32) as f32 / u32::MAX as f32 - 0.5);
    }
    let params = {
        let mut params = SurfaceParams::new(SPACING);
        params.smoothing_iterations = 7;
        params
    };
    let meshes: Vec<Mesh> = [1, 2, 8]
        .map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| reconstruct_with(&points, &params, &mut cpu()).unwrap().0)
        })
        .into();
    assert_eq!(meshes[0], meshes[1]);
    assert_eq!(meshes[0], meshes[2]);
    if let Some(gpu) = testing::gpu_or_skip("meshes_are_bit_identical_for_any_number_of_threads") {
        let mut executor = Executor::from(splashdown_gpu::GpuExecutor::new(gpu));
        let first = reconstruct_with(&points, &params, &mut executor).unwrap().0;
        assert_eq!(reconstruct_with(&points, &params, &mut executor).unwrap().0, first);
    }
}
