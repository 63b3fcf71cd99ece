//! Animated files opened by other software.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use splashdown_io::stage::{Sample, Stage};
use splashdown_io::{Mesh, Particles, StageFile};

use crate::common;
use crate::python::{Sums, close, read, same};

const RATE: f64 = 25.0;

/// A surface that falls and splits: points and triangles change, and the third frame has none.
fn frames() -> Vec<Mesh> {
    let with_velocities = |mut mesh: Mesh| {
        mesh.velocities = mesh.vertices.iter().map(|&[x, y, _]| [0.5 * x, -1.0 - y, 0.25]).collect();
        mesh
    };
    let whole = with_velocities(common::torus(0.4, 0.1, 20, 8));
    let mut halves = common::torus(0.2, 0.1, 12, 8);
    halves.normals.extend(&common::torus(0.2, 0.1, 12, 8).normals);
    let halves =
        with_velocities(common::joined(halves, &moved(common::torus(0.2, 0.1, 12, 8), [1.0, -0.2, 0.0])));
    vec![whole, halves, Mesh::default()]
}

fn moved(mut mesh: Mesh, by: [f32; 3]) -> Mesh {
    for vertex in &mut mesh.vertices {
        *vertex = std::array::from_fn(|axis| vertex[axis] + by[axis]);
    }
    mesh
}

fn write_surface(path: &Path, frames: &[Mesh]) {
    let series = StageFile::start(vec![path.to_owned()], Stage::of_surface(RATE), None).unwrap();
    for (frame, mesh) in frames.iter().enumerate() {
        series.push(frame as u32, &[(0, Sample::Mesh(Arc::new(mesh.clone())))]).unwrap();
        assert!(!path.exists(), "an unfinished file does not have its final name");
    }
    let written = series.finish();
    assert_eq!(written, [Ok((path.to_owned(), std::fs::metadata(path).unwrap().len()))]);
    assert_eq!(series.finish(), []);
}

/// A complete file and one with a vertex moved.
fn surfaces(folder: &Path) -> [PathBuf; 2] {
    let [right, wrong] = ["right.usdc", "wrong.usdc"].map(|name| folder.join(name));
    write_surface(&right, &frames());
    let mut changed = frames();
    changed[1].vertices[5][1] += 1e-3;
    changed[1].velocities[5][1] += 1.0;
    write_surface(&wrong, &changed);
    assert_eq!(common::names(folder), ["right.usdc", "wrong.usdc"], "no hidden file remains");
    [right, wrong]
}

#[test]
fn pixars_library_opens_the_animated_surface() {
    let folder = tempfile::tempdir().unwrap();
    let [right, wrong] = surfaces(folder.path());
    let test = "pixars_library_opens_the_animated_surface";
    let Some(found) = read(test, "usd", &[&right, &wrong]) else { return };
    for (name, value) in [("start", 0.0), ("end", 2.0), ("rate", RATE), ("metres", 1.0), ("y is up", 1.0)] {
        same(&found[0], name, &Sums::numbers(&[value]));
    }
    for (frame, mesh) in frames().iter().enumerate().take(2) {
        let name = |attribute: &str| format!("{attribute}@{frame}");
        same(&found[0], &name("points"), &Sums::vectors(&mesh.vertices));
        same(&found[0], &name("normals"), &Sums::vectors(&mesh.normals));
        same(&found[0], &name("velocities"), &Sums::vectors(&mesh.velocities));
        same(&found[0], &name("faceVertexIndices"), &Sums::corners(&mesh.triangles, true));
    }
    let second = &frames()[1];
    assert!(!Sums::vectors(&second.vertices).agrees(&found[1]["points@1"], 1e-9), "the control");
    assert!(!Sums::vectors(&second.velocities).agrees(&found[1]["velocities@1"], 1e-9), "the control");
    same(&found[0], "points@2", &Sums::vectors(&[]));
}

#[test]
fn blender_plays_the_animated_surface() {
    let folder = tempfile::tempdir().unwrap();
    let [right, wrong] = surfaces(folder.path());
    let Some(found) = read("blender_plays_the_animated_surface", "blender", &[&right, &wrong]) else {
        return;
    };
    let turned =
        |values: &[[f32; 3]]| -> Vec<[f32; 3]> { values.iter().map(|&[x, y, z]| [x, -z, y]).collect() };
    for (frame, mesh) in frames().iter().enumerate().take(2) {
        let name = |attribute: &str| format!("{attribute}@{frame}");
        close(&found[0], &name("positions"), &Sums::vectors(&turned(&mesh.vertices)), 1e-6);
        close(&found[0], &name("triangles"), &Sums::numbers(&[mesh.len() as f64]), 0.0);
        close(&found[0], &name("velocity"), &Sums::vectors(&turned(&mesh.velocities)), 1e-6);
    }
    let second = &frames()[1];
    assert!(!Sums::vectors(&turned(&second.vertices)).agrees(&found[1]["positions@1"], 1e-6), "the control");
}

#[test]
fn pixars_library_opens_animated_particles() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("particles.usdc");
    let series = StageFile::start(vec![path.clone()], Stage::of_particles(RATE, 0.05), None).unwrap();
    let mut frames = [common::particles(50), common::particles(40)];
    // NaN and infinity must not make the file unreadable.
    frames[1].pressures[3] = f32::NAN;
    frames[1].velocities[3][0] = f32::NEG_INFINITY;
    for (frame, particles) in frames.iter().enumerate() {
        series.push(frame as u32 + 7, &[(0, Sample::Points(Arc::new(particles.clone())))]).unwrap();
    }
    assert!(series.finish()[0].is_ok());
    let Some(found) = read("pixars_library_opens_animated_particles", "usd", &[&path]) else { return };
    let Particles { ids, positions, velocities, densities, .. } = &frames[0];
    same(&found[0], "points@7", &Sums::vectors(positions));
    same(&found[0], "velocities@7", &Sums::vectors(velocities));
    same(&found[0], "ids@7", &Sums::numbers(ids));
    same(&found[0], "primvars:density@7", &Sums::numbers(densities));
    same(&found[0], "points@8", &Sums::vectors(&frames[1].positions));
    assert!(!Sums::vectors(&frames[1].positions).agrees(&found[0]["points@7"], 1e-9), "the control");
}

#[test]
fn a_dropped_series_leaves_no_files() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("surface.usdc");
    let start = || StageFile::start(vec![path.clone()], Stage::of_surface(RATE), None).unwrap();
    let series = start();
    series.push(0, &[(0, Sample::Mesh(Arc::new(frames()[0].clone())))]).unwrap();
    drop(series);
    assert_eq!(start().finish(), []);
    assert!(common::names(folder.path()).is_empty());
}
