//! Meshes that are not part of the project, and built-in models with the same kinds of damage.

use std::path::PathBuf;

use glam::{UVec3, Vec3};
use splashdown::boundary::{KernelPair, PlaneFraction};
use splashdown::models;
use splashdown::solid::{Solid, SolidKind, SolidSettings};
use splashdown_io::Mesh;

fn shared(name: &str) -> Option<Mesh> {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/meshes").join(name);
    if !path.exists() {
        eprintln!("SKIPPED: {name} does not exist");
        return None;
    }
    Some(splashdown_io::read_mesh(&path).unwrap())
}

fn build(mesh: &Mesh, cells: f32) -> Solid {
    let (low, high) = mesh
        .vertices
        .iter()
        .fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(l, h), &v| (l.min(v.into()), h.max(v.into())));
    let cell_size = (high - low).max_element() / cells;
    let settings = SolidSettings {
        cell_size,
        support_radius: 4.0 * cell_size,
        fraction: PlaneFraction::of(KernelPair::WendlandC2),
        half_thickness: cell_size,
        shell: None,
        region: None,
        cache: None,
    };
    let begun = std::time::Instant::now();
    let solid = Solid::build(mesh, &settings, &|_| {}).unwrap();
    eprintln!("{:?}: {}", begun.elapsed(), solid.report);
    solid
}

#[test]
fn open_meshes_become_shells_and_closed_meshes_volumes() {
    for (name, kind) in [
        ("spot.obj", SolidKind::Volume),
        ("spot_ugly.obj", SolidKind::Volume),
        ("penguin.obj", SolidKind::Volume),
        ("BoxOpenedHole.obj", SolidKind::Volume),
        ("plane_holes.obj", SolidKind::Volume),
        ("cube_no_bottom.obj", SolidKind::Shell),
    ] {
        let Some(mesh) = shared(name) else { continue };
        let solid = build(&mesh, 40.0);
        eprintln!("{name}: {:?} volume {}", solid.kind, solid.mass.volume);
        assert_eq!(solid.kind, kind, "{name}: {}", solid.report);
    }
}

/// The number of nodes within three cells of the undamaged surface whose distances differ by more than a cell, and the
/// number of all nodes there.
fn differing(good: &Solid, bad: &Solid) -> (u32, u32) {
    let cell = good.field.cell_size;
    let [nx, ny, _] = good.field.nodes;
    let (mut differing, mut inside, mut all) = (0, 0, 0);
    for (k, value) in good.field.values.iter().enumerate() {
        let k = k as u32;
        let x = good.field.node(UVec3::new(k % nx, k / nx % ny, k / (nx * ny)));
        if value.x.abs() > 3.0 * cell {
            continue;
        }
        all += 1;
        inside += u32::from(value.x < 0.0);
        differing += u32::from((bad.field.distance(x) - value.x).abs() > cell);
    }
    assert!(inside > 1000);
    (differing, all)
}

#[test]
fn distances_of_the_damaged_spot_agree_with_spot() {
    let (Some(spot), Some(ugly)) = (shared("spot.obj"), shared("spot_ugly.obj")) else { return };
    let (differing, all) = differing(&build(&spot, 60.0), &build(&ugly, 60.0));
    eprintln!("{differing} of {all} nodes near the surface differ by more than a cell");
    // They differ at the hole and at floating fragments.
    assert!(f64::from(differing) < 0.05 * f64::from(all), "{differing} of {all}");
}

#[test]
fn distances_of_a_damaged_model_agree_with_the_model() {
    let figure = models::build("figure").unwrap();
    let good = build(&figure, 60.0);
    for seed in [1, 2] {
        let (differing, all) = differing(&good, &build(&models::ugly(&figure, seed), 60.0));
        eprintln!("seed {seed}: {differing} of {all} nodes near the surface differ by more than a cell");
        // The four floating fragments occupy some cells.
        assert!(f64::from(differing) < 0.05 * f64::from(all), "{differing} of {all}");
    }
    // Control: a model that is wider by 30 % is detected.
    let mut wide = figure;
    for v in &mut wide.vertices {
        v[0] *= 1.3;
    }
    let (differing, all) = differing(&good, &build(&wide, 60.0));
    assert!(f64::from(differing) > 0.05 * f64::from(all), "{differing} of {all}");
}
