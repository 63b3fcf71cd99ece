//! Thin walls, narrow slots, damaged files and random triangles.

use glam::{UVec3, Vec3};
use proptest::prelude::*;
use splashdown::boundary::{KernelPair, PlaneFraction};
use splashdown::models;
use splashdown::solid::{Solid, SolidError, SolidSettings};
use splashdown_io::Mesh;

const FRACTION: PlaneFraction = PlaneFraction { kernels: KernelPair::WendlandC2, stretch: 1.0, offset: 0.0 };
/// A power of two, so that nodes lie exactly on the middle of walls and slots, where the distance has no gradient.
const CELL: f32 = 0.0625;
const SUPPORT: f32 = 0.25;
/// Number of compared nodes per layer: those with |x| and |z| up to 0.25. Between two surfaces, at least the middle
/// layer differs from a plane.
const LAYER: u32 = 9 * 9;

fn settings() -> SolidSettings {
    SolidSettings {
        cell_size: CELL,
        support_radius: SUPPORT,
        fraction: FRACTION,
        half_thickness: CELL,
        shell: None,
        region: None,
        cache: None,
    }
}

/// The unit cube scaled to the box between two corners.
fn block(low: Vec3, high: Vec3) -> Mesh {
    let mut mesh = models::build("cube").unwrap();
    for v in &mut mesh.vertices {
        *v = (low + (Vec3::from(*v) + 0.5) * (high - low)).to_array();
    }
    mesh
}

fn joined(a: &Mesh, b: &Mesh) -> Mesh {
    let offset = a.vertices.len() as u32;
    let moved = b.triangles.iter().map(|t| t.map(|v| v + offset));
    Mesh::new(
        [a.vertices.as_slice(), &b.vertices].concat(),
        a.triangles.iter().copied().chain(moved).collect(),
    )
}

/// The kernel integral D(q) on both sides of a wall.
fn share(distance: f32) -> f32 {
    let q = (distance / SUPPORT).clamp(-1.0, 1.0);
    let d = FRACTION.kernels.gradient(q.abs()).0;
    if q < 0.0 { 1.0 - d } else { d }
}

/// Compares the kernel integral at every node near the y axis with that of the layers `solid` (lower and upper y), which
/// may extend beyond the support. Returns the number of nodes at which a plane at the same distance would fail.
fn compare_with_layers(mesh: &Mesh, solid: &[[f32; 2]]) -> u32 {
    let made = Solid::build(mesh, &settings(), &|_| {}).unwrap();
    let [nx, ny, nz] = made.field.nodes;
    let (mut checked, mut controls) = (0, 0);
    for k in 0..nx * ny * nz {
        let x = made.field.node(UVec3::new(k % nx, k / nx % ny, k / (nx * ny)));
        let value = made.field.values[k as usize];
        if x.x.abs().max(x.z.abs()) > 0.3 || value.x.abs() >= SUPPORT {
            continue;
        }
        checked += 1;
        let exact: f32 = solid.iter().map(|[low, high]| share(low - x.y) - share(high - x.y)).sum();
        assert!((share(value.y) - exact).abs() < 0.03, "{x}: {} for {exact} at {value}", share(value.y));
        controls += u32::from((share(value.x) - exact).abs() > 0.06);
    }
    assert!(checked > 300, "{checked}");
    controls
}

#[test]
fn kernel_integrals_inside_a_thin_wall_are_correct() {
    let plate = block(Vec3::new(-1.0, -CELL, -1.0), Vec3::new(1.0, CELL, 1.0));
    assert!(compare_with_layers(&plate, &[[CELL, -CELL].map(|y| -y)]) >= LAYER);
}

#[test]
fn kernel_integrals_inside_a_narrow_slot_include_both_sides() {
    let side = |low: f32, high: f32| block(Vec3::new(-1.0, low, -1.0), Vec3::new(1.0, high, 1.0));
    let walls = [[-0.5, -CELL], [CELL, 0.5]];
    let mesh = joined(&side(walls[0][0], walls[0][1]), &side(walls[1][0], walls[1][1]));
    assert!(compare_with_layers(&mesh, &walls) >= LAYER);
}

#[test]
fn a_sheet_on_grid_nodes_has_its_given_thickness() {
    let sheet = Mesh::new(
        vec![[-1.0, 0.0, -1.0], [1.0, 0.0, -1.0], [1.0, 0.0, 1.0], [-1.0, 0.0, 1.0]],
        vec![[0, 2, 1], [0, 3, 2]],
    );
    assert!(compare_with_layers(&sheet, &[[-CELL, CELL]]) >= LAYER);
}

#[test]
fn a_damaged_cache_file_is_rebuilt() {
    let folder = tempfile::tempdir().unwrap();
    let settings = SolidSettings { cell_size: 0.25, cache: Some(folder.path().to_owned()), ..settings() };
    let cube = models::build("cube").unwrap();
    let first = Solid::build(&cube, &settings, &|_| {}).unwrap();
    let file = std::fs::read_dir(folder.path()).unwrap().next().unwrap().unwrap().path();
    let good = std::fs::read(&file).unwrap();
    let same = |damaged: &[u8], what: &str| {
        std::fs::write(&file, damaged).unwrap();
        let again = Solid::build(&cube, &settings, &|_| {}).unwrap();
        // The thousands of values are not printed.
        let equal = first.mesh == again.mesh && first.report == again.report && first.field == again.field;
        assert!(equal, "{what}");
    };
    // Every byte of the header, the mesh and the first values, then a sample of the rest.
    for at in (0..700).step_by(7).chain((700..good.len()).step_by(good.len() / 20)) {
        let mut bytes = good.clone();
        bytes[at] ^= 0x01;
        same(&bytes, &format!("byte {at} of {}", good.len()));
    }
    for length in [0, 5, 11, 300, good.len() / 2, good.len() - 1] {
        same(&good[..length], &format!("cut to {length}"));
    }
    same(&[good.as_slice(), &[0]].concat(), "one byte too many");
    same(&good, "the undamaged file");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, ..ProptestConfig::default() })]

    #[test]
    fn random_triangles_give_finite_values_or_an_error(
        places in prop::collection::vec(prop::array::uniform3(prop_oneof![-1.0f32..1.0, Just(0.0), Just(0.5)]), 3..24),
        corners in prop::collection::vec(prop::array::uniform3(0u32..24), 1..40),
        shell in prop::option::of(any::<bool>()),
    ) {
        let count = places.len() as u32;
        let triangles = corners.iter().map(|t| t.map(|v| v % count)).collect();
        let mesh = Mesh::new(places, triangles);
        let settings = SolidSettings { cell_size: 0.125, support_radius: 0.25, shell, ..settings() };
        match Solid::build(&mesh, &settings, &|_| {}) {
            Ok(solid) => {
                prop_assert!(solid.field.values.iter().all(|v| v.is_finite()));
                let mass = solid.mass;
                prop_assert!(mass.volume.is_finite() && mass.volume >= 0.0);
                prop_assert!(mass.center.is_finite() && mass.inertia.is_finite());
                prop_assert!(solid.sample_surface(0.1, 0.0).iter().all(|x| x.is_finite()));
            }
            Err(error) => prop_assert!(matches!(error, SolidError::Empty { .. }), "{error}"),
        }
    }
}

/// A ball of many triangles.
fn ball() -> Mesh {
    models::build("sphere").or_else(|| models::build("ball")).unwrap()
}

/// Whether a mesh without some of its triangles is a shell.
fn is_shell(mesh: &Mesh, keep: impl Fn(usize, Vec3) -> bool) -> bool {
    let middle = |t: &[u32; 3]| t.iter().map(|&v| Vec3::from(mesh.vertices[v as usize])).sum::<Vec3>() / 3.0;
    let kept = mesh.triangles.iter().enumerate().filter(|(n, t)| keep(*n, middle(t))).map(|(_, t)| *t);
    splashdown::solid::repair(&Mesh::new(mesh.vertices.clone(), kept.collect()), None).1.shell
}

/// More damage never turns a shell into a solid.
#[test]
fn the_rule_for_shells_is_monotonic_in_damage() {
    // A number from 0 to 99 for each triangle, in no order.
    let number = |n: usize, seed: usize| ((n * 2_654_435_761 + seed * 40_503) >> 7) % 100;
    for (name, mesh) in [("ball", ball()), ("figure", models::build("figure").unwrap())] {
        for seed in 0..2 {
            let missing = [0, 1, 2, 3, 5, 8, 10, 15, 20, 30, 40, 50, 60, 70, 80, 90];
            let shells = missing.map(|part| is_shell(&mesh, |n, _| number(n, seed) >= part));
            assert!(shells.is_sorted(), "{name}, seed {seed}: {shells:?}");
            assert!(
                !shells[2] && shells[6],
                "{name}, seed {seed}: 2 % is a solid and 10 % a shell: {shells:?}"
            );
        }
        // A growing hole from above.
        let top = mesh.vertices.iter().map(|v| v[1]).fold(f32::MIN, f32::max);
        let low = mesh.vertices.iter().map(|v| v[1]).fold(f32::MAX, f32::min);
        let shells: Vec<bool> =
            (0..20).map(|k| is_shell(&mesh, |_, x| x.y < top - (top - low) * 0.05 * k as f32)).collect();
        assert!(shells.is_sorted(), "{name}: {shells:?}");
        assert!(!shells[0] && shells[18], "{name}: {shells:?}");
    }
}

/// A cube with a sheet that stands on it, without a thickness and open on three sides.
#[test]
fn an_open_fin_of_a_solid_is_a_sheet() {
    let cube = block(Vec3::splat(-0.5), Vec3::splat(0.5));
    let fin = Mesh::new(
        vec![[-0.4, 0.5, 0.0], [0.4, 0.5, 0.0], [0.4, 1.2, 0.0], [-0.4, 1.2, 0.0]],
        vec![[0, 1, 2], [0, 2, 3]],
    );
    let build =
        |mesh: &Mesh, shell| Solid::build(mesh, &SolidSettings { shell, ..settings() }, &|_| {}).unwrap();
    let solid = build(&joined(&cube, &fin), None);
    assert!(!solid.report.shell && solid.report.sheet_triangles == 2, "{}", solid.report);
    assert!(solid.report.to_string().contains("open fins (2 triangles) as sheets"));
    let at = |x: f32, y: f32, z: f32| solid.field.distance(Vec3::new(x, y, z));
    // Inside the cube, inside the sheet (half as thick as a cell on each side), and beside it.
    assert!(at(0.0, 0.0, 0.0) < -0.4);
    assert!((at(0.1, 0.9, 0.0) + CELL).abs() < 1e-3, "{}", at(0.1, 0.9, 0.0));
    assert!((at(0.1, 0.9, 0.2) - (0.2 - CELL)).abs() < 1e-2, "{}", at(0.1, 0.9, 0.2));
    // Control: as a solid the sheet has no thickness.
    let without = build(&joined(&cube, &fin), Some(false));
    assert!(without.report.sheet_triangles == 0 && without.field.distance(Vec3::new(0.1, 0.9, 0.0)) > -1e-3);
    // The cube alone has no fins; the sheet alone is a shell.
    assert_eq!(build(&cube, None).report.sheet_triangles, 0);
    assert!(build(&fin, None).report.shell);
}

/// Distances are computed only in the region, where they are those of the whole field.
#[test]
fn a_region_limits_the_field() {
    let slab = block(Vec3::new(-8.0, -0.25, -2.0), Vec3::new(8.0, 0.25, 2.0));
    let build = |region| Solid::build(&slab, &SolidSettings { region, ..settings() }, &|_| {}).unwrap();
    let whole = build(None);
    let region = (Vec3::splat(-0.5), Vec3::splat(0.5));
    let part = build(Some(region));
    let nodes = |solid: &Solid| solid.field.nodes.iter().map(|&n| u64::from(n)).product::<u64>();
    assert!(20 * nodes(&part) < nodes(&whole), "{} {}", nodes(&part), nodes(&whole));
    for k in 0..1000 {
        let x = Vec3::new((k % 10) as f32, (k / 10 % 10) as f32, (k / 100) as f32) / 9.0 - 0.5;
        let (a, b) = (whole.field.distance(x), part.field.distance(x));
        assert!((a - b).abs() < 1e-5, "{x}: {a} {b}");
    }
    // A region elsewhere gives a field without the solid.
    let far = build(Some((Vec3::splat(20.0), Vec3::splat(21.0))));
    assert!(far.field.values.iter().all(|value| value.x > 0.0));
    assert!(part.sample_surface(0.1, 0.0).len() * 5 < whole.sample_surface(0.1, 0.0).len());
}
