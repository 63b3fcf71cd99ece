//! `splashdown surface`.

use std::fs;

use serde_json::Value;
use splashdown_io::{Particles, particles, ply, read_mesh};

use crate::place::{Outcome, Place, assert_refused, stderr, stdout};

const SPACING: f32 = 0.02;

/// Particles, mesh, options, exit code, words of the message.
type Case<'a> = (&'a str, &'a str, &'a [&'a str], i32, &'a [&'a str]);

/// A block of 12 x 12 x 12 particles at a place, all of which move with one velocity.
fn block(at: [f32; 3]) -> Particles {
    let places = (0..12 * 12 * 12).map(|i| [i % 12, i / 12 % 12, i / 144].map(|c| SPACING * c as f32));
    let positions: Vec<_> = places.map(|p| std::array::from_fn(|axis| at[axis] + p[axis])).collect();
    Particles { velocities: vec![[1.0, 0.5, -2.0]; positions.len()], positions, ..Particles::default() }
}

fn with_drops(mut block: Particles, drops: usize) -> Particles {
    for drop in 0..drops {
        block.positions.push([1.0, 0.2 * drop as f32, 0.0]);
        block.velocities.push([0.0, 9.0, 0.0]);
    }
    block
}

#[test]
fn a_file_becomes_a_closed_mesh_with_velocities() -> Outcome {
    let place = Place::new()?;
    particles::write(&place.path("block.vtk"), &with_drops(block([0.0; 3]), 3))?;
    let arguments =
        ["surface", "block.vtk", "-o", "new/mesh.ply", "--particle-spacing", "0.02", "--device", "cpu"];
    let output = place.splashdown(&arguments).output()?;
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(stdout(&output).contains("watertight (closed, manifold, oriented)"), "{}", stdout(&output));
    assert!(stderr(&output).contains("[1/1] block.vtk: 1,731 particles"), "{}", stderr(&output));
    let mesh = ply::read_mesh(&place.path("new/mesh.ply"))?;
    let topology = mesh.topology()?;
    assert!(topology.is_watertight() && topology.components == 4, "{topology}");
    let volume = mesh.volume() / (1728.0 * f64::from(SPACING).powi(3));
    assert!((0.9..1.1).contains(&volume), "{volume}");
    for (vertex, velocity) in mesh.vertices.iter().zip(&mesh.velocities) {
        let wanted = if vertex[0] > 0.5 { [0.0, 9.0, 0.0] } else { [1.0, 0.5, -2.0] };
        assert!((0..3).all(|axis| (velocity[axis] - wanted[axis]).abs() < 1e-5), "{vertex:?}: {velocity:?}");
    }

    // Without the drops, and smoother.
    let more = [&arguments[..], &["--min-blob", "4", "--smoothing", "15", "--json"]].concat();
    let output = place.splashdown(&more).output()?;
    let line: Value = serde_json::from_str(stdout(&output).trim())?;
    assert_eq!((&line["dropped_blobs"], &line["pieces"]), (&Value::from(3), &Value::from(1)));
    assert_eq!(line["closed"], Value::from(true));
    let smooth = ply::read_mesh(&place.path("new/mesh.ply"))?;
    assert!(smooth.area() < 0.99 * mesh.area(), "{} and {}", smooth.area(), mesh.area());
    Ok(())
}

#[test]
fn a_series_becomes_a_series() -> Outcome {
    let place = Place::new()?;
    fs::create_dir(place.path("frames"))?;
    for number in [9, 10, 11] {
        let name = format!("frames/fluid_{number}.npz");
        particles::write(&place.path(&name), &block([0.1 * number as f32, 0.0, 0.0]))?;
    }
    for given in ["frames", "frames/fluid_*.npz"] {
        let options = ["--particle-spacing", "0.02", "--device", "cpu", "-q"];
        let output =
            place.splashdown(&[&["surface", given, "-o", "made/w_*.glb"], &options[..]].concat()).output()?;
        assert!(output.status.success(), "{}", stderr(&output));
        assert!(output.stdout.is_empty() && output.stderr.is_empty());
        for number in [9, 10, 11] {
            let path = place.path(&format!("made/w_{number:04}.glb"));
            let left =
                read_mesh(&path)?.vertices.iter().map(|vertex| vertex[0]).fold(f32::INFINITY, f32::min);
            assert!((left - 0.1 * number as f32).abs() < SPACING, "{number}: {left}");
        }
        fs::remove_dir_all(place.path("made"))?;
    }
    Ok(())
}

#[test]
fn what_is_wrong_is_said_before_anything_is_made() -> Outcome {
    let place = Place::new()?;
    particles::write(&place.path("block.ply"), &block([0.0; 3]))?;
    fs::write(place.path("empty.xyz"), "")?;
    fs::write(place.path("broken.xyz"), "0 0 0\n0 0 nan\n")?;
    fs::write(place.path("two.xyz"), "0 0 0\n0 0 1\n")?;
    fs::write(place.path("notes.txt"), "words")?;
    let spacing = ["--particle-spacing", "0.02"];
    let cases: [Case<'_>; 11] = [
        ("absent.ply", "m.ply", &spacing, 3, &["absent.ply"]),
        ("notes.txt", "m.ply", &spacing, 3, &["notes.txt", ".bgeo", ".xyz"]),
        ("empty.xyz", "m.ply", &spacing, 3, &["no particles"]),
        ("broken.xyz", "m.ply", &spacing, 3, &["1 of its 2 positions", "number 1"]),
        ("none_*.ply", "m.ply", &spacing, 3, &["none_*.ply"]),
        ("block.ply", "m.abc", &spacing, 2, &["m.abc", ".glb"]),
        ("block.ply", "block.ply", &spacing, 2, &["read and written"]),
        ("block.ply", "m.ply", &["--particle-spacing", "0.01"], 2, &["0.0200", "radius", "--force"]),
        ("block.ply", "m.ply", &["--particle-spacing", "20"], 2, &["0.0200", "--force"]),
        ("block.ply", "m.ply", &[], 2, &["--particle-spacing", "0.0200"]),
        ("two.xyz", "m.ply", &[], 2, &["too few particles"]),
    ];
    for (input, out, options, code, words) in cases {
        let output = place.splashdown(&[&["surface", input, "-o", out], options].concat()).output()?;
        assert_refused(&output, code, words);
        assert!(!place.path("m.ply").exists());
    }
    // Whoever means it gets it.
    let forced = ["surface", "block.ply", "-o", "m.ply", "-s", "0.01", "--force", "--device", "cpu"];
    assert!(place.splashdown(&forced).output()?.status.success());
    assert!(ply::read_mesh(&place.path("m.ply"))?.topology()?.components > 1000, "balls that do not touch");
    Ok(())
}
