//! Reading the frames of a run for playback: what exists is read, what is missing is reported.

use std::fs;
use std::path::Path;

use splashdown::Device;
use splashdown::scene::{Format, Scene};
use splashdown_io::{read_mesh, read_particles};
use splashdown_run::{RunError, RunFrames, RunRequest, RunSettings, Stop, run, scene_of_run};

type Outcome = Result<(), Box<dyn std::error::Error>>;

const SCENE: &str = r#"
[scene]
name = "floating"
duration = 0.02
frame_rate = 200
[domain]
min = [0, 0, 0]
max = [0.6, 0.6, 0.3]
[fluid]
particle_spacing = 0.05
[[fluid.block]]
position = [0, 0, 0]
size = [0.3, 0.2, 0.3]
[foam]
enabled = true
[[body]]
name = "ball"
mesh = "sphere"
position = [0.4, 0.4, 0.15]
move = ["0", "-2 * t", "0"]
[[body]]
name = "post"
mesh = "sphere"
scale = 0.5
position = [0.5, 0.1, 0.15]
motion = "static"
"#;

/// A run of five frames in this folder.
fn finish(out: &Path, formats: &[Format]) -> Outcome {
    let mut settings = RunSettings::default();
    settings.device = Some(Device::Cpu);
    settings.pictures = Some(Vec::new());
    settings.formats = Some(formats.to_vec());
    settings.checkpoint_every = Some(2);
    let mut request = RunRequest::new(Scene::parse(SCENE, "floating.toml")?, settings);
    request.out = Some(out.to_owned());
    let outcome = run(request, &mut (), &|| Stop::No)?;
    assert_eq!(outcome.complete_frames, 5);
    Ok(())
}

#[test]
fn a_finished_run_is_read_as_it_was_written() -> Outcome {
    let folder = tempfile::tempdir()?;
    let out = folder.path();
    finish(out, &[Format::Ply])?;
    let frames = RunFrames::open(out, None)?;
    assert_eq!(frames.numbers().collect::<Vec<_>>(), [0, 1, 2, 3, 4]);
    assert_eq!((frames.scene().name.as_str(), frames.has_checkpoint()), ("floating", true));
    assert_eq!(frames.problems().collect::<Vec<_>>(), [""; 0]);
    let names: Vec<String> = frames.body_meshes()?.into_iter().map(|body| body.name).collect();
    assert_eq!(names, ["ball", "post"]);
    let mut heights = Vec::new();
    for number in frames.numbers() {
        let frame = frames.read(number)?;
        let written = read_particles(&out.join(format!("particles/particles_{number:04}.ply")))?;
        assert_eq!(frame.particles.as_ref(), Some(&written));
        let mesh = read_mesh(&out.join(format!("mesh/surface_{number:04}.ply")))?;
        assert_eq!(frame.mesh.as_ref(), Some(&mesh));
        assert_eq!((frame.number, frame.time), (number, f64::from(number) / 200.0));
        assert!(frame.foam.is_some() && frame.problems.is_empty(), "{:?}", frame.problems);
        assert!(frame.bytes() >= 24 * written.len() + 12 * mesh.triangles.len());
        heights.push(frame.bodies[0].position.y);
        assert_eq!(frame.bodies[1].position.y, 0.1);
    }
    assert!(heights.is_sorted_by(|a, b| a > b), "the ball falls: {heights:?}");

    // What other programs need to draw the bodies.
    for body in frames.body_meshes()? {
        let written = read_mesh(&out.join(format!("bodies/{}.ply", body.name)))?;
        assert_eq!((&written.vertices, &written.triangles), (&body.mesh.vertices, &body.mesh.triangles));
    }
    let report: serde_json::Value = serde_json::from_slice(&fs::read(out.join("run.json"))?)?;
    assert_eq!(report["bodies"], serde_json::json!(["ball", "post"]));
    assert_eq!(report["gravity"], serde_json::json!([0.0, -9.81, 0.0]));
    assert_eq!(report["frame_rate"], 200.0);
    Ok(())
}

#[test]
fn missing_mixed_and_truncated_files_are_reported_and_the_rest_is_read() -> Outcome {
    let folder = tempfile::tempdir()?;
    let out = folder.path();
    finish(out, &[Format::Ply])?;
    let truncate = |name: &str| -> Outcome {
        let path = out.join(name);
        let bytes = fs::read(&path)?;
        fs::write(path, &bytes[..bytes.len() / 2])?;
        Ok(())
    };
    for name in ["particles/particles_0001.ply", "mesh/surface_0001.ply", "mesh/surface_0002.ply"] {
        fs::remove_file(out.join(name))?;
    }
    truncate("particles/particles_0003.ply")?;
    truncate("particles/particles_0004.ply")?;
    truncate("mesh/surface_0004.ply")?;
    fs::remove_file(out.join("bodies/ball.csv"))?;
    // The place of a dynamic body is known from its table only.
    let dynamic = SCENE.replace("move = [\"0\", \"-2 * t\", \"0\"]", "motion = \"dynamic\"");
    let frames = RunFrames::open(out, Some(Scene::parse(&dynamic, "floating.toml")?))?;
    assert_eq!(frames.numbers().collect::<Vec<_>>(), [0, 2, 3, 4]);
    let problems: Vec<String> = frames.problems().collect();
    assert_eq!(problems[..2], ["frame 1 missing", "frame 2 without a mesh"], "{problems:?}");
    assert!(problems[2].contains("\"ball\" is not shown"), "{problems:?}");
    assert_eq!(frames.body_meshes()?.len(), 1);
    let whole = frames.read(0)?;
    assert!(whole.particles.is_some() && whole.mesh.is_some() && whole.problems.is_empty());
    let without_mesh = frames.read(2)?;
    assert!(without_mesh.particles.is_some() && without_mesh.mesh.is_none());
    let truncated = frames.read(3)?;
    assert!(truncated.particles.is_none() && truncated.mesh.is_some());
    assert!(truncated.problems[0].contains("particles_0003.ply"), "{:?}", truncated.problems);
    let Err(RunError::Input(reason)) = frames.read(4) else {
        panic!("a frame without usable files was read")
    };
    assert!(reason.contains("particles_0004.ply") && reason.contains("surface_0004.ply"), "{reason}");
    // A frame in a second format replaces a file that cannot be read.
    let particles = whole.particles.ok_or("no particles")?;
    splashdown_io::write_particles(&out.join("particles/particles_0003.vtu"), &particles)?;
    let mixed = RunFrames::open(out, None)?.read(3)?;
    assert!(mixed.particles.is_some() && mixed.problems.is_empty(), "{:?}", mixed.problems);
    Ok(())
}

/// Changes values of the report of a run.
fn change_report(out: &Path, change: impl Fn(&mut serde_json::Map<String, serde_json::Value>)) -> Outcome {
    let path = out.join("run.json");
    let mut report: serde_json::Map<String, serde_json::Value> = serde_json::from_slice(&fs::read(&path)?)?;
    change(&mut report);
    Ok(fs::write(path, serde_json::to_vec(&report)?)?)
}

#[test]
fn the_scene_comes_from_the_report_then_from_the_checkpoint_then_from_the_named_file() -> Outcome {
    let folder = tempfile::tempdir()?;
    let out = folder.path().join("out");
    finish(&out, &[Format::Ply])?;
    let scene = Scene::parse(SCENE, "floating.toml")?;
    let checkpoints = [out.join("checkpoints"), folder.path().join("moved")];
    // The text in the report is sufficient. The settings of the run are applied: it drew no pictures.
    fs::rename(&checkpoints[0], &checkpoints[1])?;
    let read = scene_of_run(&out)?;
    assert_eq!((&read.bodies, &read.text), (&scene.bodies, &scene.text));
    assert!(read.output.pictures.is_empty() && !scene.output.pictures.is_empty());
    // A run of an earlier version has a checkpoint or the name of a scene, here of a built-in one.
    change_report(&out, |report| {
        assert!(report.remove("scene_text").is_some_and(|text| text == SCENE));
    })?;
    assert_ne!(scene_of_run(&out)?.bodies, scene.bodies);
    fs::rename(&checkpoints[1], &checkpoints[0])?;
    assert_eq!(scene_of_run(&out)?.bodies, scene.bodies);
    fs::remove_dir_all(&checkpoints[0])?;
    change_report(&out, |report| {
        report.insert("scene".to_owned(), "nowhere".into());
    })?;
    let unknown = scene_of_run(&out);
    assert!(
        matches!(&unknown, Err(RunError::UnknownScene(reason)) if reason.contains("nowhere")),
        "{unknown:?}"
    );
    assert!(RunFrames::open(&out, Some(scene)).is_ok());
    let empty = tempfile::tempdir()?;
    assert!(!RunFrames::exist_in(empty.path()));
    assert!(matches!(RunFrames::open(empty.path(), None), Err(RunError::Input(_))));
    Ok(())
}

#[test]
fn a_scene_file_that_has_changed_or_is_gone_does_not_matter() -> Outcome {
    let folder = tempfile::tempdir()?;
    let [file, mesh, out] = ["my.toml", "ball.obj", "out"].map(|name| folder.path().join(name));
    fs::write(&mesh, "v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nv 0 0 0.1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")?;
    fs::write(&file, SCENE.replacen("mesh = \"sphere\"", "mesh = \"ball.obj\"", 1))?;
    let mut settings = RunSettings::default();
    (settings.device, settings.pictures, settings.frames) = (Some(Device::Cpu), Some(Vec::new()), Some(1));
    let scene = Scene::load(&file)?;
    let mut request = RunRequest::new(scene.clone(), settings);
    request.out = Some(out.clone());
    let outcome = run(request, &mut (), &|| Stop::No)?;
    assert_eq!(outcome.complete_frames, 2);
    let frames = RunFrames::open(&out, None)?;
    assert_eq!((frames.scene().bodies.len(), frames.body_meshes()?.len()), (2, 2));
    // The mesh is found from the folder of the scene file. Without it only its body is missing.
    assert_eq!(frames.scene().bodies, scene.bodies);
    fs::remove_file(&file)?;
    fs::remove_file(&mesh)?;
    let frames = RunFrames::open(&out, None)?;
    assert_eq!(frames.scene().bodies, scene.bodies);
    assert!(frames.body_meshes().is_err() && frames.read(1).is_ok());
    Ok(())
}

#[test]
fn frames_without_a_row_in_the_table_of_a_body_are_reported_once() -> Outcome {
    let folder = tempfile::tempdir()?;
    let out = folder.path();
    finish(out, &[Format::Ply])?;
    fs::copy(out.join("mesh/surface_0003.ply"), out.join("mesh/surface_0040.ply"))?;
    let table = out.join("bodies/ball.csv");
    let rows: Vec<String> = fs::read_to_string(&table)?.lines().map(str::to_owned).collect();
    fs::write(&table, format!("{}\n{}\n{}\n{}\n", rows[0], rows[1], rows[2], &rows[3][..20]))?;
    let frames = RunFrames::open(out, None)?;
    let problems: Vec<String> = frames.problems().collect();
    let ball = problems.iter().find(|problem| problem.contains("\"ball\"")).ok_or("not reported")?;
    assert!(ball.contains("frames 2 to 4, 40") && ball.contains("nearest known place"), "{problems:?}");
    assert_eq!(frames.read(40)?.bodies[0], frames.read(1)?.bodies[0]);
    assert!(
        problems.iter().any(|problem| problem.starts_with("frame 40 without files of spray")),
        "{problems:?}"
    );
    Ok(())
}
