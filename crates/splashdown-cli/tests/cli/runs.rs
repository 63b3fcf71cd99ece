//! Complete runs of a small scene: files, console output and JSON lines.

use std::fs;
use std::path::Path;

use crate::place::{Outcome, Place, assert_refused, can_draw, lines, names, stderr, stdout};
use serde_json::{Value, json};
use splashdown_io::{ParticleInfo, ply};

/// Keys that every line has.
const KEYS: [&str; 11] = [
    "event",
    "frame",
    "time",
    "steps",
    "dt",
    "particles",
    "density_error",
    "max_speed",
    "volume",
    "triangles",
    "files",
];

#[test]
fn a_run_leaves_complete_frames_and_a_summary() -> Outcome {
    let place = Place::new()?;
    let output = place.run_small(&["--formats", "ply,vtu,obj"]).output()?;
    assert!(output.status.success(), "{}", stderr(&output));
    for word in [
        "particle-steps per second",
        "simulated seconds per second",
        "density error",
        "volume",
        "particles_*.ply",
    ] {
        assert!(stdout(&output).contains(word), "{word} is missing in:\n{}", stdout(&output));
    }
    let mut particles = Vec::new();
    for frame in 0..=2 {
        particles.push(ply::read_particles(&place.path(&format!("out/particles/particles_000{frame}.ply")))?);
        let mesh = ply::read_mesh(&place.path(&format!("out/mesh/surface_000{frame}.ply")))?;
        assert!(mesh.topology()?.is_watertight(), "frame {frame}");
        assert!((mesh.volume() / 0.027 - 1.0).abs() < 0.3, "frame {frame} encloses {} m^3", mesh.volume());
        assert!(place.path(&format!("out/mesh/surface_000{frame}.obj")).exists());
    }
    assert!(particles.iter().all(|particles| particles.len() == 216 && particles.check().is_ok()));
    // Control: the frames differ.
    assert_ne!(particles[0].positions, particles[2].positions);
    let series = fs::read_to_string(place.path("out/particles/particles.pvd"))?;
    assert_eq!(series.matches(".vtu\"").count(), 3, "{series}");
    let report: Value = serde_json::from_str(&fs::read_to_string(place.path("out/run.json"))?)?;
    assert_eq!((&report["status"], &report["complete_frames"]), (&Value::from("finished"), &Value::from(3)));
    assert!(report["summary"]["particle_steps_per_second"].as_f64().is_some_and(|speed| speed > 0.0));
    Ok(())
}

#[test]
fn spray_foam_and_bubbles_have_separate_files() -> Outcome {
    let place = Place::new()?;
    let scene = "[scene]\nname = \"foam\"\nduration = 0.5\nframe_rate = 10\n[domain]\nmin = [0, 0, 0]\nmax = [0.8, 0.8, 0.2]\n\
                 [fluid]\nparticle_spacing = 0.025\n[[fluid.block]]\nposition = [0, 0, 0]\nsize = [0.25, 0.4, 0.2]\n[foam]\nenabled = true\n";
    let file = place.write("foam.toml", scene)?;
    let file = file.to_str().ok_or("no name")?;
    let options =
        ["--device", "cpu", "--formats", "ply,vtu", "--no-pictures", "--no-surface", "--out", "out"];
    let output = place.splashdown(&[&["run", file][..], &options].concat()).output()?;
    assert!(output.status.success(), "{}", stderr(&output));
    let count = |kind: &str, frame: u32| -> Result<usize, Box<dyn std::error::Error>> {
        assert!(place.path(&format!("out/particles/{kind}_000{frame}.vtu")).exists());
        let particles = ply::read_particles(&place.path(&format!("out/particles/{kind}_000{frame}.ply")))?;
        assert_eq!((particles.velocities.len(), particles.ids.len()), (particles.len(), particles.len()));
        Ok(particles.len())
    };
    for kind in ["spray", "foam", "bubbles"] {
        // A column at rest generates none, a collapsing one generates some.
        assert_eq!(count(kind, 0)?, 0);
        assert!(count(kind, 5)? > 0, "there are no {kind}");
    }
    for kind in ["particles", "spray", "foam", "bubbles"] {
        let index = fs::read_to_string(place.path(&format!("out/particles/{kind}.pvd")))?;
        for frame in 0..=5 {
            let time = format!("timestep=\"{}\"", f64::from(frame) / 10.0);
            let file = format!("file=\"{kind}_000{frame}.vtu\"");
            assert!(
                index.lines().any(|line| line.contains(&time) && line.contains(&file)),
                "{kind}: {index}"
            );
        }
        assert_eq!(index.matches("<DataSet ").count(), 6, "{kind}: {index}");
    }
    // Only the series that exist have an index.
    assert!(!place.path("out/mesh").exists() && !place.path("out/droplets").exists());
    // Empty files have them too.
    for frame in [0, 5] {
        let file = |ending: &str| place.path(&format!("out/particles/spray_000{frame}.{ending}"));
        let header = String::from_utf8_lossy(&fs::read(file("ply"))?).into_owned();
        let time = format!("comment time {}\n", f64::from(frame) / 10.0);
        assert!(
            header.contains(&time) && header.contains("comment particle_spacing 0.025\n"),
            "{header:.200}"
        );
        let xml = String::from_utf8_lossy(&fs::read(file("vtu"))?).into_owned();
        assert!(
            xml.contains("Name=\"TimeValue\"") && xml.contains("Name=\"particle_spacing\""),
            "{xml:.400}"
        );
    }
    Ok(())
}

#[test]
fn isolated_particles_leave_the_surface_and_are_written_as_droplets() -> Outcome {
    let place = Place::new()?;
    // A block and a single particle above it.
    let scene = "[scene]\nname = \"drop\"\nduration = 0.02\nframe_rate = 100\n[domain]\nmin = [0, 0, 0]\nmax = [0.4, 0.8, 0.4]\n\
                 [fluid]\nparticle_spacing = 0.05\n[[fluid.block]]\nposition = [0, 0, 0]\nsize = [0.4, 0.2, 0.4]\n\
                 [[fluid.block]]\nposition = [0.2, 0.6, 0.2]\nsize = [0.05, 0.05, 0.05]\n\
                 [foam]\nenabled = true\n[output]\npicture_size = [96, 64]\n";
    place.write("drop.toml", scene)?;
    let options = ["--device", "cpu", "--no-pictures", "--json", "-o", "out"];
    let run =
        |more: &[&str]| place.splashdown(&[&["run", "drop.toml"], &options[..], more].concat()).output();
    let file = |name: &str| place.path(&format!("out/{name}"));
    let output = run(&["--formats", "ply,vtk,vtp,vtu,glb,usd"])?;
    assert!(output.status.success(), "{}", stderr(&output));
    for frame in 0..=2 {
        let name = format!("droplets_000{frame}");
        let droplets = splashdown_io::read_particles_with_attributes(&file(&format!("droplets/{name}.ply")))?;
        assert_eq!((droplets.len(), droplets.velocities.len(), &droplets.ids[..]), (1, 1, &[256][..]));
        let width =
            droplets.attributes.iter().find(|attribute| attribute.name == "width").ok_or("no width")?;
        assert!((width.values[0] / 0.05 - 1.2407).abs() < 1e-3, "{width:?}");
        let info = droplets.info;
        assert_eq!((info.time, info.particle_spacing), (Some(f64::from(frame) / 100.0), Some(0.05)));
        assert!(["vtk", "glb"].iter().all(|ending| file(&format!("droplets/{name}.{ending}")).exists()));
        let mesh = ply::read_mesh(&file(&format!("mesh/surface_000{frame}.ply")))?;
        assert_eq!(mesh.topology()?.components, 1);
        let line =
            lines(&output)?.into_iter().find(|line| line["event"] == "frame" && line["frame"] == frame);
        let line = line.ok_or("no line")?;
        assert_eq!(line["droplets"], 1);
        let droplet = line["volume"].as_f64().ok_or("no volume")? - mesh.volume();
        assert!((droplet / 0.05_f64.powi(3) - 1.0).abs() < 1e-2, "{droplet} m^3");
    }
    // Of two formats an index lists the files of the first.
    for name in ["droplets/droplets", "mesh/surface", "particles/particles"] {
        let index = fs::read_to_string(file(&format!("{name}.pvd")))?;
        let stem = name.rsplit('/').next().unwrap_or_default();
        let last = format!("timestep=\"0.02\" group=\"\" part=\"0\" file=\"{stem}_0002.vtp\"");
        assert!(index.contains(&last) && index.matches("<DataSet ").count() == 3, "{index}");
    }
    // Foam is written as points, too.
    assert!(file("particles/spray_0002.glb").exists() && file("particles.usdc").exists());
    assert!(fs::read(file("scene.usdc"))?.starts_with(b"PXR-USDC"));
    let scene = glb_document(&file("scene.glb"))?;
    let nodes: Vec<&str> =
        scene["nodes"].as_array().ok_or("nodes")?.iter().filter_map(|node| node["name"].as_str()).collect();
    for name in ["surface_0000", "surface_0002", "droplets_0001", "tank", "camera", "splashdown"] {
        assert!(nodes.contains(&name), "{name} is not in {nodes:?}");
    }
    assert!(!nodes.contains(&"spray_0000"), "no spray at the start: {nodes:?}");
    let droplets =
        scene["meshes"].as_array().ok_or("meshes")?.iter().find(|mesh| mesh["name"] == "droplets_0001");
    let droplets = droplets.ok_or("no droplets")?;
    assert!((droplets["extras"]["diameter"].as_f64().ok_or("no diameter")? - 0.062_035).abs() < 1e-5);
    assert!(droplets["primitives"][0]["attributes"]["_VELOCITY"].is_u64(), "{droplets}");

    // Drawn again, with and without limits.
    if can_draw() {
        for more in [&[][..], &["--min-blob", "0", "--min-neighbours", "0"]] {
            let render = ["render", "out", "--frames", "1", "--quality", "interactive"];
            let output = place.splashdown(&[&render, more].concat()).output()?;
            assert!(output.status.success(), "{}", stderr(&output));
        }
        let pictures = ["render", "render-2"].map(|name| fs::read(file(&format!("{name}/picture_0000.png"))));
        let [with, without] = pictures;
        // The droplet of the files is not part of the mesh, whatever the limits.
        assert!(with? == without?);
    }

    // Without limits the drop is a component of the mesh. Files of the earlier run are removed.
    let output = run(&["--min-blob", "0", "--min-neighbours", "0", "--formats", "ply"])?;
    assert!(output.status.success(), "{}", stderr(&output));
    let mesh = ply::read_mesh(&file("mesh/surface_0000.ply"))?;
    assert_eq!(mesh.topology()?.components, 2);
    assert!(!file("mesh/surface.pvd").exists() && !file("particles/foam.pvd").exists());
    assert!(!file("droplets/droplets_0000.glb").exists() && !file("scene.usdc").exists());

    for (command, limit) in [("run", "33"), ("render", "-1")] {
        let input = if command == "run" { "drop.toml" } else { "out" };
        let output = place.splashdown(&[command, input, "--min-blob", limit]).output()?;
        assert_refused(&output, 2, &["--min-blob", "from 0 to 32"]);
    }
    Ok(())
}

#[test]
fn every_json_line_has_every_key() -> Outcome {
    let place = Place::new()?;
    let output = place.run_small(&["--json", "--formats", "ply,usd"]).output()?;
    assert!(output.status.success(), "{}", stderr(&output));
    let lines = lines(&output)?;
    for line in &lines {
        for key in KEYS {
            assert!(line.get(key).is_some(), "{key} is missing in {line}");
        }
    }
    let of = |event: &str| lines.iter().filter(|line| line["event"] == event).collect::<Vec<_>>();
    assert_eq!((of("started").len(), of("frame").len(), of("finished").len()), (1, 3, 1));
    assert_eq!(lines.first().map(|line| &line["event"]), Some(&Value::from("started")));
    assert_eq!(lines.last().map(|line| &line["event"]), Some(&Value::from("finished")));
    let last = lines.last().map(|line| line["files"].to_string()).unwrap_or_default();
    assert!(last.contains("run.json") && last.contains("scene.usdc") && !last.contains("_0002"), "{last}");
    for (index, frame) in of("frame").into_iter().enumerate() {
        assert_eq!(frame["frame"], index);
        assert_eq!(frame["particles"], 216);
        assert!(frame["volume"].as_f64().is_some_and(|volume| volume > 0.0));
        assert!(frame["triangles"].as_u64().is_some_and(|count| count > 100));
        let files = frame["files"].as_array().ok_or("no files")?;
        assert_eq!(files.len(), 3, "{frame}");
        for file in files {
            assert!(place.path(file.as_str().ok_or("no name")?).exists(), "{file}");
        }
    }
    Ok(())
}

#[test]
fn results_are_bit_identical_with_any_number_of_threads() -> Outcome {
    let place = Place::new()?;
    let run = |out: &str, threads: &str, more: &[&str]| {
        let mut command =
            place.splashdown(&["run", "small.toml", "--device", "cpu", "--no-pictures", "-q", "--out", out]);
        command.args(more).env("RAYON_NUM_THREADS", threads).output()
    };
    for (out, threads) in [("one", "1"), ("two", "2"), ("eight", "8")] {
        assert!(run(out, threads, &[])?.status.success());
    }
    let mut differences = 0;
    for folder in ["particles", "mesh"] {
        for name in names(&place.path("one").join(folder))? {
            let bytes = |out: &str| fs::read(place.path(out).join(folder).join(&name));
            assert_eq!(bytes("one")?, bytes("two")?, "{name}");
            assert_eq!(bytes("one")?, bytes("eight")?, "{name}");
            differences += usize::from(
                name.contains("0002")
                    && bytes("one")?
                        != fs::read(place.path("one").join(folder).join(name.replace("0002", "0000")))?,
            );
        }
    }
    assert_eq!(differences, 2, "control: files of different times differ");
    Ok(())
}

#[test]
fn options_select_the_files_written() -> Outcome {
    let place = Place::new()?;
    let output = place.run_small(&["--no-surface", "--frames", "1", "--formats", "vtu"]).output()?;
    assert!(output.status.success(), "{}", stderr(&output));
    assert_eq!(names(&place.path("out"))?, ["particles", "run.json"]);
    assert_eq!(
        names(&place.path("out/particles"))?,
        ["particles.pvd", "particles_0000.vtu", "particles_0001.vtu"]
    );

    let output = place.run_small(&["--formats", "none", "--frames", "1", "-q"]).output()?;
    assert!(
        output.status.success() && output.stdout.is_empty() && output.stderr.is_empty(),
        "{}",
        stderr(&output)
    );
    assert_eq!(names(&place.path("out"))?, ["run.json"], "the files of the earlier run are removed");

    let output = place.run_small(&["--timing", "--frames", "1", "--formats", "none"]).output()?;
    assert!(stdout(&output).contains("| pass |"), "{}", stdout(&output));
    Ok(())
}

#[test]
fn a_built_in_scene_runs_by_its_name() -> Outcome {
    let place = Place::new()?;
    let arguments =
        ["run", "dam-break-small", "--frames", "1", "--no-pictures", "--no-surface", "--device", "cpu"];
    let output = place.splashdown(&arguments).output()?;
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(place.path("out/dam-break-small/particles/particles_0001.ply").exists());
    Ok(())
}

#[test]
fn pictures_and_films_are_made() -> Outcome {
    if !can_draw() {
        return Ok(());
    }
    let place = Place::new()?;
    let output = place
        .splashdown(&[
            "run",
            "small.toml",
            "--out",
            "out",
            "--device",
            "cpu",
            "--formats",
            "none",
            "--timing",
        ])
        .output()?;
    assert!(output.status.success(), "{}", stderr(&output));
    // Without timestamps the passes of the pictures are not measured, which is a warning.
    if !stderr(&output).contains("no timestamps") {
        assert!(stdout(&output).contains("| pass of pictures |"), "{}", stdout(&output));
        let report: Value = serde_json::from_slice(&fs::read(place.path("out/run.json"))?)?;
        assert!(report["picture_passes"]["scene"]["count"].as_u64() > Some(0), "{report}");
        assert!(report["passes"]["scene"].is_null(), "negative control: a pass of the pictures only");
    }
    for kind in ["surface", "particles"] {
        let pictures: Vec<_> = (0..=2)
            .map(|i| fs::read(place.path(&format!("out/pictures/{kind}_000{i}.png"))))
            .collect::<Result<_, _>>()?;
        assert!(pictures.iter().all(|bytes| bytes.starts_with(b"\x89PNG") && bytes.len() > 1000), "{kind}");
        assert_ne!(pictures[0], pictures[2], "control: the pictures of different times differ");
        let film = place.path(&format!("out/{kind}.mp4"));
        if film.exists() {
            assert!(fs::metadata(film)?.len() > 500);
        } else {
            assert!(stderr(&output).contains("ffmpeg"), "neither a film nor a hint: {}", stderr(&output));
        }
    }
    Ok(())
}

#[test]
fn without_ffmpeg_pictures_are_written_and_its_command_is_printed() -> Outcome {
    if !can_draw() {
        return Ok(());
    }
    let place = Place::new()?;
    let mut command = place.splashdown(&[
        "run",
        "small.toml",
        "--out",
        "out",
        "--device",
        "cpu",
        "--formats",
        "none",
        "--frames",
        "1",
    ]);
    let output = command.env("PATH", "").output()?;
    assert!(output.status.success(), "{}", stderr(&output));
    for word in ["ffmpeg", "-framerate", "surface_%04d.png", "particles_%04d.png"] {
        assert!(stderr(&output).contains(word), "{word} is missing in:\n{}", stderr(&output));
    }
    assert_eq!(names(&place.path("out/pictures"))?.len(), 4);
    assert!(!place.path("out/surface.mp4").exists());
    Ok(())
}

#[test]
fn the_benchmark_accepts_a_scene_and_numbers_of_threads() -> Outcome {
    let place = Place::new()?;
    let words = ["bench", "--scene", "small.toml", "--steps", "2", "--device", "cpu", "--threads", "1,2"];
    let output = place.splashdown(&[&words[..], &["--json", "--no-passes"]].concat()).output()?;
    assert!(output.status.success(), "{}", stderr(&output));
    let rows: Vec<Value> =
        stdout(&output).lines().map(serde_json::from_str).collect::<Result<_, serde_json::Error>>()?;
    let threads: Vec<_> = rows.iter().map(|row| row["threads"].as_u64()).collect();
    assert_eq!(threads, [Some(1), Some(2)]);
    for row in rows {
        assert_eq!(row["device"], format!("CPU ({} threads)", row["threads"]));
        assert!(
            row["particles"].as_u64().is_some_and(|count| count > 0) && row["passes"] == json!({}),
            "{row}"
        );
        // The roofline counts the dispatches even if the passes are not reported.
        assert!(row["dispatches_per_step"].as_f64().is_some_and(|count| count > 4.0), "{row}");
        let ratio = row["support_radius"]
            .as_f64()
            .zip(row["spacing"].as_f64())
            .map(|(radius, spacing)| radius / spacing);
        assert!(ratio.is_some_and(|ratio| (ratio - 2.0).abs() < 1e-5), "{row}");
    }
    let output = place.splashdown(&words).output()?;
    assert!(stdout(&output).contains("on 2 threads over 1:"), "{}", stdout(&output));
    Ok(())
}

#[test]
fn the_benchmark_measures_steps_and_passes() -> Outcome {
    let output =
        crate::place::splashdown(&["bench", "--particles", "128,1K", "--steps", "2", "--device", "cpu"])
            .output()?;
    assert!(output.status.success(), "{}", stderr(&output));
    for word in ["| particles |", "| 128 |", "largest over the smallest", "| pass |"] {
        assert!(stdout(&output).contains(word), "{word} is missing in:\n{}", stdout(&output));
    }
    let output = crate::place::splashdown(&[
        "bench",
        "--particles",
        "512",
        "--steps",
        "2",
        "--device",
        "cpu",
        "--json",
    ])
    .output()?;
    let row: Value = serde_json::from_slice(&output.stdout)?;
    assert!(row["seconds_per_step"].as_f64().is_some_and(|seconds| seconds > 0.0));
    assert!(row["passes"].as_object().is_some_and(|passes| passes.len() > 3), "{row}");
    Ok(())
}

#[test]
fn each_probe_has_a_table_with_units() -> Outcome {
    let place = Place::new()?;
    let scene = fs::read_to_string(place.path("small.toml"))?;
    let probe = "[[probe]]\nname = \"gauge\"\nquantity = \"pressure\"\nposition = [0.1, 0.02, 0.1]\n\
                 [[probe]]\nname = \"all\"\nquantity = \"fluid\"\n";
    // Without initial pressure there is no elastic energy. The table of the gauge has a row for every step.
    let solver = "[solver]\nmethod = \"wcsph\"\ncfl_factor = 0.3\n[fluid]\ninitial_pressure = \"zero\"";
    let scene = scene.replace("[fluid]", solver);
    fs::write(place.path("small.toml"), format!("{scene}\n{probe}"))?;
    // A table of an earlier run, which is removed, and an unrelated file, which is not.
    fs::create_dir_all(place.path("out/probes"))?;
    fs::write(place.path("out/run.json"), "{}")?;
    fs::write(place.path("out/probes/old.csv"), "time (s),height (m)\n0.1,0.2\n")?;
    fs::write(place.path("out/probes/notes.csv"), "mine\n")?;
    let output = place.run_small(&["--formats", "none"]).output()?;
    assert!(output.status.success(), "{}", stderr(&output));
    let text = fs::read_to_string(place.path("out/probes/gauge.csv"))?;
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("time (s),pressure (Pa)"));
    let times: Vec<f64> = lines.filter_map(|line| line.split(',').next()?.parse().ok()).collect();
    assert!(times.len() >= 18 && times.windows(2).all(|pair| pair[0] < pair[1]), "{text}");
    let text = fs::read_to_string(place.path("out/probes/all.csv"))?;
    let mut lines = text.lines();
    assert!(lines.next().is_some_and(|names| names.starts_with("time (s),volume (m^3),kinetic energy (J)")));
    let rows: Vec<Vec<f64>> =
        lines.map(|line| line.split(',').filter_map(|word| word.parse().ok()).collect()).collect();
    // 27 l of water at a mean height of 15 cm. Potential energy becomes kinetic energy, minus friction.
    assert_eq!(rows.len(), 3, "{text}");
    for row in &rows {
        let [_, volume, kinetic, potential, _, momentum, _] = row[..] else { panic!("{text}") };
        assert!((volume / 0.027 - 1.0).abs() < 1e-6, "{text}");
        let lost = rows[0][3] - potential;
        assert!(kinetic <= 1.1 * lost + 1e-9 && momentum <= 1e-9, "{text}");
    }
    assert!((rows[0][3] / (27.0 * 9.81 * 0.15) - 1.0).abs() < 0.01, "{text}");
    assert!(rows[2][2] > 1e-4 && rows[2][5] < -1e-2, "{text}");
    assert!(!place.path("out/probes/old.csv").exists() && place.path("out/probes/notes.csv").exists());
    assert!(stdout(&output).contains("probes/gauge.csv"), "{}", stdout(&output));
    Ok(())
}

/// The description in a GLB file.
fn glb_document(path: &Path) -> Result<Value, Box<dyn std::error::Error>> {
    let bytes = fs::read(path)?;
    let length = u32::from_le_bytes(bytes[12..16].try_into()?) as usize;
    Ok(serde_json::from_slice(&bytes[20..20 + length])?)
}

#[test]
fn every_format_contains_the_same_frames() -> Outcome {
    let place = Place::new()?;
    let formats = "ply,vtu,vtp,obj,vtk,bgeo,npz,stl,glb,usd";
    let output = place.run_small(&["--formats", formats]).output()?;
    assert!(output.status.success(), "{}", stderr(&output));
    for frame in 0..=2 {
        let file = |name: &str| place.path(&format!("out/{name}").replace('#', &format!("000{frame}")));
        let particles = ply::read_particles(&file("particles/particles_#.ply"))?;
        assert_eq!(particles.info, ParticleInfo::new(f64::from(frame) / 200.0, 0.05));
        for ending in ["vtu", "vtp", "vtk", "bgeo", "npz"] {
            let mut other = splashdown_io::read_particles(&file(&format!("particles/particles_#.{ending}")))?;
            // BGEO has only single precision.
            let time = other.info.time.map(|time| time as f32);
            assert_eq!(time, particles.info.time.map(|time| time as f32), "{ending}");
            other.info.time = particles.info.time;
            assert_eq!(other, particles, "{ending}");
        }
        let mesh = ply::read_mesh(&file("mesh/surface_#.ply"))?;
        for ending in ["obj", "stl", "glb", "vtk", "vtp"] {
            let other = splashdown_io::read_mesh(&file(&format!("mesh/surface_#.{ending}")))?;
            assert_eq!(other.len(), mesh.len(), "{ending}");
            assert!((other.volume() / mesh.volume() - 1.0).abs() < 1e-5, "{ending}");
        }
        // The vertices fall at about the same speed as the particles.
        let mean = |values: &[[f32; 3]]| values.iter().map(|v| v[1]).sum::<f32>() / values.len() as f32;
        let (fluid, surface) = (mean(&particles.velocities), mean(&mesh.velocities));
        assert!(
            (fluid - surface).abs() < 0.1 + 0.3 * fluid.abs(),
            "frame {frame}: {fluid} and {surface} m/s"
        );
        assert_eq!(frame > 0, surface < -0.01, "frame {frame}: {surface} m/s");
    }
    // `surface` needs no spacing for these files.
    for ending in ["ply", "vtu", "vtp", "vtk", "bgeo", "npz"] {
        let (given, out) = (format!("out/particles/particles_*.{ending}"), format!("m/{ending}_*.ply"));
        let output = place.splashdown(&["surface", &given, "-o", &out, "-d", "cpu", "--json"]).output()?;
        assert!(output.status.success(), "{ending}: {}", stderr(&output));
        let spacings: Vec<_> = lines(&output)?.iter().map(|line| line["particle_spacing"].as_f64()).collect();
        assert_eq!(spacings, [Some(0.05); 3], "{ending}");
        assert!(ply::read_mesh(&place.path(&format!("m/{ending}_0002.ply")))?.topology()?.is_watertight());
    }
    for name in ["scene.usdc", "particles.usdc"] {
        assert!(fs::read(place.path(&format!("out/{name}")))?.starts_with(b"PXR-USDC"), "{name}");
    }
    let scene = glb_document(&place.path("out/scene.glb"))?;
    assert_eq!(scene["animations"][0]["channels"].as_array().map(Vec::len), Some(5), "{scene:.400}");
    let hidden = fs::read_dir(place.path("out"))?.flatten();
    assert!(hidden.into_iter().all(|entry| !entry.file_name().to_string_lossy().starts_with('.')));
    Ok(())
}
