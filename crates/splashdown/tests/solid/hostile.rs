//! Thin walls, narrow slots, damaged files and random triangles.

use glam::{UVec3, Vec3};
use proptest::prelude::*;
use splashdown::boundary::KernelPair;
use splashdown::models;
use splashdown::solid::{Solid, SolidError, SolidSettings};
use splashdown_io::Mesh;

const KERNELS: KernelPair = KernelPair::WendlandC2;
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
        kernels: KERNELS,
        half_thickness: CELL,
        shell: None,
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
    let d = KERNELS.gradient(q.abs()).0;
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
