//! `splashdown surface`.

use std::fs;

use serde_json::Value;
use splashdown_io::{
    Mesh, ParticleInfo, Particles, ply, read_mesh, read_particles_with_attributes, write_particles,
};

use crate::place::{Outcome, Place, assert_refused, lines, stderr, stdout};

const SPACING: f32 = 0.02;

/// Particles, mesh, options, exit code, words of the message.
type Case<'a> = (&'a str, &'a str, &'a [&'a str], i32, &'a [&'a str]);

/// A block of 12 x 12 x 12 particles with its lowest corner at `at`, all with the same velocity.
fn block(at: [f32; 3]) -> Particles {
    let places = (0..12 * 12 * 12).map(|i| [i % 12, i / 12 % 12, i / 144].map(|c| SPACING * c as f32));
    let positions: Vec<_> = places.map(|p| std::array::from_fn(|axis| at[axis] + p[axis])).collect();
    let velocities = vec![[1.0, 0.5, -2.0]; positions.len()];
    Particles::from_positions(positions).with_velocities(velocities)
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
    write_particles(&place.path("block.vtk"), &with_drops(block([0.0; 3]), 3))?;
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

    // With anisotropic kernels a drop of one particle has its volume.
    let output =
        place.splashdown(&[&arguments[..], &["--kernels", "anisotropic", "--json"]].concat()).output()?;
    let line: Value = serde_json::from_str(stdout(&output).trim())?;
    let volume = line["volume"].as_f64().unwrap_or_default() / f64::from(SPACING).powi(3);
    assert!((volume / 1731.0 - 1.0).abs() < 0.02, "{volume}");
    let mut drops = ply::read_mesh(&place.path("new/mesh.ply"))?;
    splashdown::surface::remove_small_components(&mut drops, 100.0 * f64::from(SPACING).powi(3));
    let volume = volume - drops.volume() / f64::from(SPACING).powi(3);
    assert!((2.7..3.3).contains(&volume), "{volume}");

    // Without the drops, and smoothed.
    let more = [&arguments[..], &["--min-blob", "4", "--smoothing", "15", "--json"]].concat();
    let output = place.splashdown(&more).output()?;
    let line: Value = serde_json::from_str(stdout(&output).trim())?;
    assert_eq!((&line["droplets"], &line["pieces"]), (&Value::from(3), &Value::from(1)));
    assert_eq!(line["closed"], Value::from(true));
    let smooth = ply::read_mesh(&place.path("new/mesh.ply"))?;
    assert!(smooth.area() < 0.99 * mesh.area(), "{} and {}", smooth.area(), mesh.area());
    Ok(())
}

#[test]
fn isolated_particles_are_written_to_their_own_file() -> Outcome {
    let place = Place::new()?;
    for number in [1, 2] {
        write_particles(&place.path(&format!("in_{number}.ply")), &with_drops(block([0.0; 3]), 3 * number))?;
    }
    let surface = |more: &[&str]| {
        let options = ["surface", "in_*.ply", "-o", "made/w_*.ply", "-s", "0.02", "-d", "cpu"];
        place.splashdown(&[&options, more].concat()).output()
    };
    let output = surface(&["--min-neighbours", "3", "--droplets", "made/drops_*.ply"])?;
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(stderr(&output).contains("6 isolated particles left out"), "{}", stderr(&output));
    for number in [1, 2] {
        let drops = read_particles_with_attributes(&place.path(&format!("made/drops_000{number}.ply")))?;
        assert_eq!((drops.len(), drops.velocities[0]), (3 * number, [0.0, 9.0, 0.0]));
        assert_eq!(drops.ids[0], 1728);
        let width = drops.attributes.iter().find(|attribute| attribute.name == "width").ok_or("no width")?;
        let volume = std::f32::consts::PI / 6.0 * width.values[0].powi(3);
        assert!((volume / SPACING.powi(3) - 1.0).abs() < 1e-5, "{volume}");
        let mesh = ply::read_mesh(&place.path(&format!("made/w_000{number}.ply")))?;
        assert_eq!(mesh.topology()?.components, 1);
    }
    // Blobs of any size, and points in a format of meshes.
    assert!(surface(&["--min-blob", "1000", "--droplets", "made/drops_*.glb"])?.status.success());
    assert!(place.path("made/drops_0002.glb").exists());
    Ok(())
}

/// The numbers of each vertex of a PLY file whose properties are all floats, with their names.
fn columns(file: &[u8]) -> Option<(Vec<String>, Vec<Vec<f32>>)> {
    let end = b"end_header\n";
    let start = file.windows(end.len()).position(|window| window == end)? + end.len();
    let header = String::from_utf8_lossy(&file[..start]).into_owned();
    let names = header.lines().filter_map(|line| line.strip_prefix("property float "));
    let names: Vec<String> = names.map(str::to_owned).collect();
    let count: usize = header.lines().find_map(|line| line.strip_prefix("element vertex "))?.parse().ok()?;
    let word = |bytes: &[u8]| f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
    let rows = file[start..].chunks_exact(4 * names.len()).take(count);
    Some((names, rows.map(|row| row.chunks_exact(4).map(word).collect()).collect()))
}

#[test]
fn attributes_of_particles_are_interpolated_to_the_vertices() -> Outcome {
    let place = Place::new()?;
    let block = block([0.0; 3]);
    let list = |number: &dyn Fn(&[f32; 3]) -> String| -> String {
        block.positions.iter().map(|place| number(place) + "\n").collect()
    };
    let count = block.len();
    let text = format!(
        "# vtk DataFile Version 3.0\nhot water\nASCII\nDATASET POLYDATA\nPOINTS {count} float\n{}POINT_DATA {count}\n\
         SCALARS temperature double 1\nLOOKUP_TABLE default\n{}VECTORS force float\n{}SCALARS id int 1\n{}",
        list(&|[x, y, z]| format!("{x} {y} {z}")),
        list(&|[x, ..]| format!("{}", 290.0 + 100.0 * x)),
        list(&|_| "1 -2 0.5".to_owned()),
        list(&|_| "7".to_owned()),
    );
    place.write("hot.vtk", text)?;
    let surface = |out: &str, more: &[&str]| {
        place
            .splashdown(&[&["surface", "hot.vtk", "-o", out, "-s", "0.02", "-d", "cpu"], more].concat())
            .output()
    };
    let output = surface("all.ply", &["--attribute", "all"])?;
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(stderr(&output).contains("with temperature, force,"), "{}", stderr(&output));
    let (names, rows) = columns(&fs::read(place.path("all.ply"))?).ok_or("no PLY")?;
    assert_eq!(names[6..], ["temperature", "force_x", "force_y", "force_z"]);
    let mut off = 0.0_f32;
    for row in &rows {
        // A constant attribute is interpolated exactly. One with a slope of 100 has an error that depends on the
        // distance to the particles.
        let force = [row[7] - 1.0, row[8] + 2.0, row[9] - 0.5];
        assert!(force.iter().all(|off| off.abs() < 1e-5), "{row:?}");
        off = off.max((row[6] - 290.0 - 100.0 * row[0]).abs());
    }
    assert!(off < 100.0 * SPACING && off > 0.1 * SPACING, "{off}");

    // One attribute; the mesh is the same.
    let output = surface("one.ply", &["-a", "force"])?;
    assert!(output.status.success(), "{}", stderr(&output));
    let (names, _) = columns(&fs::read(place.path("one.ply"))?).ok_or("no PLY")?;
    assert_eq!(names[6..], ["force_x", "force_y", "force_z"]);
    let mesh = |name: &str| read_mesh(&place.path(name));
    assert_eq!(mesh("one.ply")?, mesh("all.ply")?);
    assert!(surface("one.vtk", &["-a", "temperature", "-a", "force"])?.status.success());
    let vtk = fs::read(place.path("one.vtk"))?;
    for words in ["SCALARS temperature float 1\n", "VECTORS force float\n"] {
        assert!(vtk.windows(words.len()).any(|window| window == words.as_bytes()), "{words}");
    }
    Ok(())
}

#[test]
fn a_series_of_particle_files_gives_a_series_of_meshes() -> Outcome {
    let place = Place::new()?;
    fs::create_dir(place.path("frames"))?;
    for number in [9, 10, 11] {
        let name = format!("frames/fluid_{number}.npz");
        write_particles(&place.path(&name), &block([0.1 * number as f32, 0.0, 0.0]))?;
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

/// The spacing in the line of each mesh.
fn spacings(output: &std::process::Output) -> Result<Vec<Option<f64>>, Box<dyn std::error::Error>> {
    Ok(lines(output)?.iter().map(|line| line["particle_spacing"].as_f64()).collect())
}

#[test]
fn the_particle_spacing_is_that_of_the_file() -> Outcome {
    let place = Place::new()?;
    let info = |spacing: f32| ParticleInfo::new(0.25, spacing);
    let surface = |input: &str, out: &str, more: &[&str]| {
        place.splashdown(&[&["surface", input, "-o", out, "-d", "cpu", "--json"], more].concat()).output()
    };
    for ending in ["ply", "vtk", "vtu", "vtp", "bgeo", "npz"] {
        let name = format!("block.{ending}");
        write_particles(&place.path(&name), &block([0.0; 3]).with_info(info(SPACING)))?;
        let contained = surface(&name, "a.ply", &[])?;
        assert!(contained.status.success(), "{ending}: {}", stderr(&contained));
        assert_eq!(spacings(&contained)?, [Some(0.02)], "{ending}");
        assert!(surface(&name, "b.ply", &["-s", "0.02"])?.status.success(), "{ending}");
        let mesh = |name: &str| read_mesh(&place.path(name));
        assert_eq!(mesh("a.ply")?, mesh("b.ply")?, "{ending}");
        // The option takes precedence.
        let given = surface(&name, "c.ply", &["-s", "0.025"])?;
        assert_eq!(spacings(&given)?, [Some(0.025)], "{ending}");
        assert_ne!(mesh("a.ply")?, mesh("c.ply")?, "{ending}");
        // Negative control: the same file without it.
        write_particles(&place.path(&name), &block([0.0; 3]))?;
        let missing = surface(&name, "d.ply", &[])?;
        assert_refused(&missing, 2, &["--particle-spacing is missing", &name, "0.0200"]);
    }

    // Each file of a series has its own; a file without it is reported, and the others are meshed.
    let mut twice = block([0.0; 3]).with_info(info(2.0 * SPACING));
    twice.positions.iter_mut().flatten().for_each(|x| *x *= 2.0);
    write_particles(&place.path("s_0001.npz"), &block([0.0; 3]).with_info(info(SPACING)))?;
    write_particles(&place.path("s_0002.npz"), &twice)?;
    let series = surface("s_*.npz", "made/w_*.vtp", &[])?;
    assert!(series.status.success(), "{}", stderr(&series));
    assert_eq!(spacings(&series)?, [Some(0.02), Some(0.04)]);
    let volume = |number: u32| read_mesh(&place.path(&format!("made/w_000{number}.vtp")));
    assert!((volume(2)?.volume() / volume(1)?.volume() - 8.0).abs() < 1e-3);
    write_particles(&place.path("s_0003.npz"), &block([0.0; 3]))?;
    let series = surface("s_*.npz", "made/w_*.vtp", &[])?;
    assert_eq!((series.status.code(), spacings(&series)?.len()), (Some(1), 2));
    assert!(stderr(&series).contains("s_0003.npz"), "{}", stderr(&series));
    Ok(())
}

#[test]
fn a_spacing_in_a_file_that_does_not_fit_is_refused() -> Outcome {
    let place = Place::new()?;
    let header = |spacing: &str| {
        let positions = block([0.0; 3]).positions;
        let rows: String = positions.iter().map(|[x, y, z]| format!("{x} {y} {z}\n")).collect();
        format!(
            "ply\nformat ascii 1.0\ncomment particle_spacing {spacing}\nelement vertex {}\nproperty float x\n\
             property float y\nproperty float z\nend_header\n{rows}",
            positions.len()
        )
    };
    let surface = |more: &[&str]| {
        place.splashdown(&[&["surface", "a.ply", "-o", "m.ply", "-d", "cpu"], more].concat()).output()
    };
    for wrong in ["20", "1e-6", "1e11"] {
        place.write("a.ply", header(wrong))?;
        assert_refused(&surface(&[])?, 2, &["a.ply", "contains a particle spacing", "0.0200", "--force"]);
        assert!(!place.path("m.ply").exists(), "{wrong}");
    }
    for ignored in ["nan", "-0.02", "0", "inf", "1e300", "1e-300", "wide"] {
        place.write("a.ply", header(ignored))?;
        assert_refused(&surface(&[])?, 2, &["--particle-spacing is missing", "0.0200"]);
    }
    // An option replaces a wrong spacing, and drops that are far from each other are accepted.
    place.write("a.ply", header("20"))?;
    assert!(surface(&["-s", "0.02"])?.status.success());
    place.write("a.ply", header("0.004"))?;
    assert!(surface(&[])?.status.success());
    Ok(())
}

#[test]
fn errors_are_reported_before_anything_is_written() -> Outcome {
    let place = Place::new()?;
    write_particles(&place.path("block.ply"), &block([0.0; 3]))?;
    fs::write(place.path("empty.xyz"), "")?;
    fs::write(place.path("broken.xyz"), "0 0 0\n0 0 nan\n")?;
    fs::write(place.path("two.xyz"), "0 0 0\n0 0 1\n")?;
    fs::write(place.path("notes.txt"), "words")?;
    let spacing = ["--particle-spacing", "0.02"];
    let corners = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let face = Mesh::new(corners, vec![[0, 1, 2]]);
    splashdown_io::write_mesh(&place.path("mesh.ply"), &face)?;
    let cases: [Case<'_>; 22] = [
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
        ("mesh.ply", "m.ply", &spacing, 3, &["mesh.ply", "it is a mesh of 1 face"]),
        ("block.ply", "m.ply", &["-s", "-1"], 2, &["a length is a number above 0"]),
        ("block.ply", "m.ply", &["-s", "1e-7", "--force"], 3, &["block.ply", "cell_size"]),
        (
            "block.ply",
            "m.ply",
            &["-s", "0.02", "--iso-level", "5"],
            2,
            &["no surface", "iso_level of 5", "from 0 outside to 1."],
        ),
        (
            "block.ply",
            "m.ply",
            &["-s", "0.02", "--min-blob", "-1"],
            2,
            &["--min-blob", "from 0 to 1000000000"],
        ),
        ("block.ply", "m.ply", &["-s", "0.02", "--min-neighbours", "33"], 2, &["33", "from 0 to 32"]),
        ("block.ply", "m.ply", &["-s", "0.02", "--droplets", "d.obj"], 2, &["d.obj", ".ply", ".glb"]),
        ("block.ply", "m.ply", &["-s", "0.02", "--droplets", "m.ply"], 2, &["m.ply", "--droplets"]),
        ("block.ply", "m*/x.ply", &spacing, 2, &["m*/x.ply", "star"]),
        ("block.ply", "m.obj", &["-s", "0.02", "-a", "all"], 2, &["m.obj", ".ply, .vtk, .vtp"]),
        ("block.ply", "m.ply", &["-s", "0.02", "-a", "heat"], 2, &["`heat`", "it has velocity"]),
    ];
    for (input, out, options, code, words) in cases {
        let output = place.splashdown(&[&["surface", input, "-o", out], options].concat()).output()?;
        assert_refused(&output, code, words);
        assert!(!place.path("m.ply").exists());
    }
    // `--force` accepts it.
    let forced = ["surface", "block.ply", "-o", "m.ply", "-s", "0.01", "--force", "--device", "cpu"];
    assert!(place.splashdown(&forced).output()?.status.success());
    assert!(ply::read_mesh(&place.path("m.ply"))?.topology()?.components > 1000, "one sphere per particle");
    Ok(())
}
