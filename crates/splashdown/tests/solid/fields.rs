use glam::{UVec3, Vec3};
use splashdown::boundary::{KernelPair, PlaneFraction};
use splashdown::models;
use splashdown::solid::{Solid, SolidError, SolidKind, SolidSettings};
use splashdown_io::Mesh;

fn settings(cell_size: f32, support_radius: f32) -> SolidSettings {
    SolidSettings {
        cell_size,
        support_radius,
        fraction: PlaneFraction::of(KernelPair::WendlandC2),
        half_thickness: cell_size,
        shell: None,
        region: None,
        cache: None,
    }
}

fn build(mesh: &Mesh, settings: &SolidSettings) -> Solid {
    Solid::build(mesh, settings, &|_| {}).unwrap()
}

/// Nodes with their position, distance and effective distance.
fn nodes(solid: &Solid) -> impl Iterator<Item = (Vec3, f32, f32)> + '_ {
    let field = &solid.field;
    let [nx, ny, _] = field.nodes;
    field.values.iter().enumerate().map(move |(k, value)| {
        let k = k as u32;
        (field.node(UVec3::new(k % nx, k / nx % ny, k / (nx * ny))), value.x, value.y)
    })
}

#[test]
fn distances_and_masses_of_a_cube_match_closed_forms() {
    let solid = build(&models::build("cube").unwrap(), &settings(0.05, 0.2));
    assert_eq!(solid.kind, SolidKind::Volume);
    let mut near = 0;
    for (x, phi, _) in nodes(&solid) {
        let q = x.abs() - 0.5;
        let exact = q.max(Vec3::ZERO).length() + q.max_element().min(0.0);
        if exact.abs() < 0.2 {
            near += 1;
            assert!((phi - exact).abs() < 1e-4, "{x}: {phi} for {exact}");
        } else {
            assert!(phi * exact > 0.0 && phi.abs() > 0.19, "{x}: {phi} for {exact}");
        }
    }
    assert!(near > 1000);
    let mass = solid.mass;
    assert!((mass.volume - 1.0).abs() < 1e-4 && mass.center.length() < 1e-4);
    assert!((mass.inertia.x_axis.x - 1.0 / 6.0).abs() < 1e-4 && mass.inertia.x_axis.y.abs() < 1e-4);
}

#[test]
fn the_kernel_integral_of_a_cube_is_a_plane_at_faces_and_smaller_at_edges() {
    let solid = build(&models::build("cube").unwrap(), &settings(0.05, 0.2));
    let (mut faces, mut edges) = (0, 0);
    for (x, phi, effective) in nodes(&solid) {
        let beside = Vec3::new(x.y.abs(), x.z.abs(), 0.0).max_element();
        if x.x > 0.5 && phi < 0.2 && beside < 0.25 {
            faces += 1;
            assert!((effective - phi).abs() < 0.002, "{x}: {effective} for a plane at {phi}");
        }
        let edge = (x.x - 0.5).abs() < 0.026 && (x.y - 0.5).abs() < 0.026 && x.z.abs() < 0.2;
        if edge {
            edges += 1;
            // About a quarter of space: less than half of the kernel.
            assert!(effective > phi + 0.01, "{x}: {effective} at {phi}");
        }
    }
    assert!(faces > 50 && edges > 4, "{faces} {edges}");
}

/// The part of the kernel's integral behind two planes at a right angle, at distances a and b, by the midpoint rule.
fn edge_integral(a: f32, b: f32) -> f32 {
    const N: i32 = 40;
    let at = |i: i32| (i as f32 + 0.5) / N as f32;
    let mut sum = 0.0;
    for (i, j) in (0..N * N).map(|k| (k / N, k % N)) {
        let (x, y) = (a + (1.0 - a) * at(i), b + (1.0 - b) * at(j));
        let z: f32 =
            (0..N).map(|k| KernelPair::WendlandC2.w((x * x + y * y + at(k) * at(k)).sqrt().min(1.0))).sum();
        sum += 2.0 * z;
    }
    sum * (1.0 - a) * (1.0 - b) / (N as f32).powi(3)
}

#[test]
fn the_kernel_integral_at_an_edge_is_that_of_the_wedge() {
    let solid = build(&models::build("cube").unwrap(), &settings(0.025, 0.2));
    let mut checked = 0;
    for (x, phi, effective) in nodes(&solid) {
        let (a, b) = ((x.x - 0.5) / 0.2, (x.y - 0.5) / 0.2);
        if a < 0.05 || b < 0.05 || a * a + b * b > 0.6 || x.z.abs() > 0.2 {
            continue;
        }
        checked += 1;
        // The solid is the intersection of the half-spaces behind x = 0.5 and y = 0.5.
        let exact = edge_integral(a, b);
        let share = |distance: f32| KernelPair::WendlandC2.gradient((distance / 0.2).min(1.0)).0;
        // The linear interpolation of the grid smooths the crease by less than a cell.
        assert!((share(effective) - exact).abs() < 0.01, "{x}: {} for {exact}", share(effective));
        // Control: near the edge, a plane at the same distance has another value.
        if phi < 0.03 {
            assert!((share(phi) - exact).abs() > 0.05, "{x}");
        }
    }
    assert!(checked > 100, "{checked}");
}

#[test]
fn a_damaged_mesh_is_rejected_with_a_reason() {
    let cube = models::build("cube").unwrap();
    let settings = settings(0.1, 0.2);
    let refused = |change: &dyn Fn(&mut Mesh)| {
        let mut mesh = cube.clone();
        change(&mut mesh);
        Solid::build(&mesh, &settings, &|_| {}).map(drop).unwrap_err()
    };
    assert!(matches!(refused(&|m| m.triangles.clear()), SolidError::Empty { .. }));
    assert!(matches!(refused(&|m| m.vertices[3][1] = f32::NAN), SolidError::NotFinite { index: 3, .. }));
    assert!(matches!(refused(&|m| m.triangles[2][0] = 99), SolidError::BadTriangle { triangle: 2, .. }));
    assert!(matches!(refused(&|m| m.vertices.fill([1.0; 3])), SolidError::Empty { .. }));
    assert!(matches!(refused(&|m| m.vertices[0][0] = 1e6), SolidError::TooLarge { .. }));
    assert!(Solid::build(&cube, &settings, &|_| {}).is_ok());
}

#[test]
fn a_second_build_is_cached_and_a_damaged_file_is_rebuilt() {
    let folder = tempfile::tempdir().unwrap();
    let settings = SolidSettings { cache: Some(folder.path().to_owned()), ..settings(0.05, 0.2) };
    let cube = models::build("cube").unwrap();
    let first = build(&cube, &settings);
    let file = std::fs::read_dir(folder.path()).unwrap().next().unwrap().unwrap().path();
    let reports = std::sync::atomic::AtomicU32::new(0);
    let again = |reports: &std::sync::atomic::AtomicU32| {
        Solid::build(&cube, &settings, &|_| {
            reports.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
        })
        .unwrap()
    };
    let second = again(&reports);
    assert_eq!(reports.load(std::sync::atomic::Ordering::Relaxed), 0, "the solid was built again");
    assert_eq!((&first.field, &first.mesh, first.report), (&second.field, &second.mesh, second.report));
    let mut bytes = std::fs::read(&file).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 0x40;
    std::fs::write(&file, &bytes).unwrap();
    let third = again(&reports);
    assert!(reports.load(std::sync::atomic::Ordering::Relaxed) > 0, "a damaged file was accepted");
    assert_eq!(first.field, third.field);
}

#[test]
fn lattice_and_surface_samples_of_a_cube() {
    let solid = build(&models::build("cube").unwrap(), &settings(0.05, 0.2));
    let points =
        solid.fill(Vec3::new(2.0, 0.0, 0.0), glam::Quat::IDENTITY, 0.1, Vec3::new(2.05, 0.05, 0.05), 0.045);
    assert_eq!(points.len(), 1000);
    let samples = solid.sample_surface(0.1, 0.05);
    // The samples lie on the cube of 0.9, half a spacing inside; a random packing is less dense than a lattice.
    let lattice = 6.0 * 0.9 * 0.9 / 0.01;
    let ratio = samples.len() as f32 / lattice;
    assert!(ratio > 0.8 && ratio < 1.2, "{ratio}");
    for (i, a) in samples.iter().enumerate() {
        assert!(samples[..i].iter().all(|b| a.distance(*b) > 0.08), "{i}");
        assert!((solid.field.distance(*a) + 0.05).abs() < 0.03, "{a}");
    }
}
