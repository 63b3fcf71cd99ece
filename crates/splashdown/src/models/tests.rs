use std::collections::HashMap;
use std::f64::consts::PI;
use std::sync::LazyLock;

use glam::Vec3;
use splashdown_io::Mesh;

use super::{build, names, ugly};

/// Every model, built once for all tests.
static MODELS: LazyLock<HashMap<&str, Mesh>> =
    LazyLock::new(|| names().iter().filter_map(|&(name, _)| Some((name, build(name)?))).collect());

fn model(name: &str) -> Mesh {
    MODELS.get(name).cloned().unwrap_or_else(|| panic!("no model {name}"))
}

/// Lower and upper corners of a mesh's bounding box.
fn bounds(mesh: &Mesh) -> (Vec3, Vec3) {
    let points = mesh.vertices.iter().map(|&v| Vec3::from(v));
    points.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)))
}

/// Euler characteristics: 2 minus two for every hole through the model. The rail and the 14 posts of the
/// gallery form 14 holes. The buoy has 13 from two rings on four legs and two eyes. The gear has six and its
/// bore.
const EULER: &[(&str, i64)] = &[
    ("lighthouse", 2 - 2 * 14),
    ("cup", 0),
    ("buoy", 2 - 2 * 13),
    ("spout", 0),
    ("gear", 2 - 2 * 7),
    ("drum", 2),
    ("torus-knot", 0),
    ("sphere", 2),
    ("cube", 2),
    ("block", 2),
    ("marin-box", 2),
    ("ramp", 2),
    ("steps", 2),
];

#[test]
fn every_model_is_closed_manifold_and_oriented_outwards() {
    for (name, what) in names() {
        let mesh = model(name);
        let topology = mesh.topology().unwrap_or_else(|e| panic!("{name}: {e}"));
        assert!(topology.is_manifold() && topology.is_oriented(), "{name}: {topology}");
        assert_eq!(topology.is_closed(), *name != "thin-cup", "{name}: {topology}");
        assert_eq!(topology.components, 1, "{name}: {topology}");
        assert_eq!(topology.unused_vertices, 0, "{name}: {topology}");
        assert!(mesh.volume() > 0.0 || *name == "thin-cup", "{name} is inside out: {} m^3", mesh.volume());
        if let Some((_, euler)) = EULER.iter().find(|(known, _)| known == name) {
            assert_eq!(topology.euler_characteristic, *euler, "{name}: {topology}");
        }
        assert!(mesh.len() < 70_000, "{name}: {} triangles", mesh.len());
        assert!(what.contains(" m"), "the description of {name} does not state its size: {what}");
    }
    assert!(build("teapot").is_none());
}

/// The fraction of triangles that face away from the mean of their vertex normals.
fn folded(mesh: &Mesh) -> f64 {
    let away = mesh.triangles.iter().filter(|corners| {
        let [a, b, c] = corners.map(|i| Vec3::from(mesh.vertices[i as usize]));
        let mean: Vec3 = corners.iter().map(|&i| Vec3::from(mesh.normals[i as usize])).sum();
        (b - a).cross(c - a).dot(mean) < 0.0
    });
    away.count() as f64 / mesh.len() as f64
}

#[test]
fn normals_agree_with_the_triangles() {
    for (name, _) in names() {
        let mut mesh = model(name);
        if mesh.normals.is_empty() {
            continue;
        }
        assert!(mesh.normals.iter().all(|&n| (Vec3::from(n).length() - 1.0).abs() < 1e-3), "{name}");
        assert!(folded(&mesh) < 0.002, "{name}: {:.4} of the triangles are folded over", folded(&mesh));
        // Negative control: all triangles of a mesh turned inside out are folded.
        for corners in &mut mesh.triangles {
            corners.swap(1, 2);
        }
        assert!(folded(&mesh) > 0.99, "{name}");
    }
}

#[test]
fn volumes_match_the_formulas() {
    let ball = 4.0 / 3.0 * PI * 1e-3;
    for (name, volume, tolerance) in [
        ("sphere", ball, 0.005),
        ("cube", 1.0, 1e-6),
        ("block", 0.008, 0.02),
        ("marin-box", 0.161 * 0.161 * 0.403, 1e-6),
        ("ramp", 0.5 * 0.3 * 0.5, 1e-6),
        ("steps", 0.2 * 0.1 * 15.0 * 0.5, 1e-6),
    ] {
        let given = model(name).volume();
        assert!((given / volume - 1.0).abs() < tolerance, "{name}: {given} m^3 instead of {volume}");
    }
}

#[test]
fn models_stand_on_the_ground_and_have_the_described_height() {
    for name in ["lighthouse", "figure", "cup", "thin-cup", "thin-cup-filling", "marin-box", "ramp", "steps"]
    {
        let (low, _) = bounds(&model(name));
        assert!(low.y.abs() < 1e-3, "the base of {name} is at y = {}", low.y);
    }
    for (name, low, high) in [
        ("lighthouse", 0.97, 1.02),
        ("figure", 0.97, 1.02),
        ("cup", 0.098, 0.102),
        ("thin-cup", 0.0999, 0.1001),
        ("thin-cup-filling", 0.0999, 0.1001),
        ("marin-box", 0.161, 0.161),
    ] {
        let size = bounds(&model(name)).1.y;
        assert!((low..=high).contains(&size), "{name} is {size} m high");
    }
}

#[test]
fn models_are_reproducible() {
    for name in ["lighthouse", "figure"] {
        assert_eq!(build(name).as_ref(), Some(&model(name)), "{name}");
    }
    let sphere = model("sphere");
    assert_eq!(ugly(&sphere, 1), ugly(&sphere, 1));
    assert_ne!(ugly(&sphere, 1), ugly(&sphere, 2));
}

#[test]
fn the_damaged_mesh_has_every_defect() -> Result<(), Box<dyn std::error::Error>> {
    let sphere = model("sphere");
    let damaged = ugly(&sphere, 3);
    let report = damaged.topology()?;
    assert!(damaged.normals.is_empty() && damaged.len() > sphere.len());
    assert_eq!(report.components, damaged.len(), "triangles share no vertices: {report}");
    let volume = damaged.volume() / sphere.volume();
    assert!((0.7..0.9).contains(&volume), "a tenth of the triangles is reversed: volume {volume}");
    let area = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|i| Vec3::from(damaged.vertices[i as usize]));
        (b - a).cross(c - a).length()
    };
    assert!(damaged.triangles.iter().filter(|t| area(t) == 0.0).count() > 100);
    assert!(bounds(&damaged).1.y > 0.105, "there is no separate tetrahedron");
    Ok(())
}
