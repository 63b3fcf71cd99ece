//! Runs by the library without the command line: stopping, resuming, and the calls to a reporter.

use std::cell::Cell;
use std::fs;
use std::path::Path;

use splashdown::Device;
use splashdown::run::{Progress, Started};
use splashdown::scene::{Format, PictureKind, Scene};
use splashdown_run::{
    CompleteFrame, Reporter, RunEnd, RunError, RunFrames, RunOutcome, RunRequest, RunSettings, Session, Stop,
    run,
};

type Outcome = Result<(), Box<dyn std::error::Error>>;

const SCENE: &str = r#"
[scene]
name = "small"
duration = 0.02
frame_rate = 200
[domain]
min = [0, 0, 0]
max = [1, 1, 0.3]
[fluid]
particle_spacing = 0.05
[[fluid.block]]
position = [0, 0, 0]
size = [0.3, 0.3, 0.3]
"#;

/// Records what a run reports.
#[derive(Default)]
struct Log {
    started: Vec<u32>,
    frames: Vec<u32>,
    warnings: Vec<String>,
}

impl Reporter for Log {
    fn warning(&mut self, text: &str) {
        self.warnings.push(text.to_owned());
    }

    fn started(&mut self, started: &Started) {
        self.started.push(started.first_frame);
    }

    fn progress(&mut self, progress: &Progress) {
        assert!(progress.frame <= progress.frames);
    }

    fn frame_complete(&mut self, frame: &CompleteFrame) {
        assert!(frame.files.iter().all(|file| file.exists()), "{frame:?}");
        self.frames.push(frame.summary.index);
    }
}

fn settings() -> RunSettings {
    let mut settings = RunSettings::default();
    settings.device = Some(Device::Cpu);
    settings.pictures = Some(Vec::new());
    settings
}

fn request(out: &Path) -> Result<RunRequest, Box<dyn std::error::Error>> {
    let mut request = RunRequest::new(Scene::parse(SCENE, "small.toml")?, settings());
    request.out = Some(out.to_owned());
    Ok(request)
}

fn assert_finished(outcome: &RunOutcome) {
    assert!(matches!(outcome.end, RunEnd::Finished(_)), "{outcome:?}");
    assert_eq!(outcome.complete_frames, 5);
}

#[test]
fn a_stopped_run_resumes_bit_identically() -> Outcome {
    let folder = tempfile::tempdir()?;
    let [uninterrupted, out] = ["uninterrupted", "out"].map(|name| folder.path().join(name));
    assert_finished(&run(request(&uninterrupted)?, &mut (), &|| Stop::No)?);

    let mut log = Log::default();
    let polls = Cell::new(0);
    let stop = || {
        polls.set(polls.get() + 1);
        if polls.get() > 2 { Stop::AfterFrame } else { Stop::No }
    };
    let stopped = run(request(&out)?, &mut log, &stop)?;
    assert!(matches!(stopped.end, RunEnd::Interrupted) && stopped.resumable, "{stopped:?}");
    let frames = stopped.complete_frames as u32;
    assert!((1..5).contains(&frames));
    assert_eq!((log.started, log.frames), (vec![0], (0..frames).collect()));

    // The folder contains all settings; none has to be given again.
    let mut log = Log::default();
    let resumed = run(RunRequest::resume(&out, RunSettings::default())?, &mut log, &|| Stop::No)?;
    assert_finished(&resumed);
    assert_eq!((log.started, log.frames), (vec![frames - 1], (frames..5).collect()));
    assert_eq!(log.warnings, [""; 0]);
    for frame in 0..5 {
        let name = format!("particles/particles_{frame:04}.ply");
        assert!(fs::read(uninterrupted.join(&name))? == fs::read(out.join(&name))?, "{name}");
    }

    // The checkpoint is later than the last requested frame.
    let mut settings = RunSettings::default();
    settings.frames = Some(frames - 1);
    let shorter = run(RunRequest::resume(&out, settings)?, &mut (), &|| Stop::No);
    assert!(matches!(shorter, Err(RunError::AlreadyFinished { .. })), "{shorter:?}");
    Ok(())
}

#[test]
fn the_report_of_a_resumed_run_says_that_it_is_running() -> Outcome {
    let folder = tempfile::tempdir()?;
    let out = folder.path().join("out");
    let stopped = run(request(&out)?, &mut (), &|| Stop::AfterFrame)?;
    let report = || fs::read_to_string(stopped.folder.report());
    assert!(report()?.contains("\"interrupted\""), "{}", report()?);
    // A refused start keeps the report.
    let mut settings = RunSettings::default();
    (settings.surface, settings.pictures) = (false, Some(vec![PictureKind::Surface]));
    let refused = RunRequest::resume(&out, settings).and_then(|short| Session::start(short, &mut ()));
    assert!(refused.is_err());
    assert!(report()?.contains("\"interrupted\""), "{}", report()?);
    // The report of a run that is killed, which a dropped session resembles.
    drop(Session::start(RunRequest::resume(&out, RunSettings::default())?, &mut ())?);
    let frames = format!("\"complete_frames\": {}", stopped.complete_frames);
    assert!(report()?.contains("\"running\"") && report()?.contains(&frames), "{}", report()?);
    assert_finished(&run(RunRequest::resume(&out, RunSettings::default())?, &mut (), &|| Stop::No)?);
    assert!(report()?.contains("\"finished\""), "{}", report()?);
    Ok(())
}

#[test]
fn a_folder_is_used_by_one_run_at_a_time() -> Outcome {
    let folder = tempfile::tempdir()?;
    let out = folder.path().join("out");
    let first = Session::start(request(&out)?, &mut ())?;
    let second = Session::start(request(&out)?, &mut ());
    assert!(matches!(second, Err(RunError::FolderInUse { .. })));
    assert_finished(&first.finish(&mut (), &|| Stop::No));
    assert_finished(&run(request(&out)?, &mut (), &|| Stop::No)?);
    Ok(())
}

#[test]
fn a_failure_after_the_start_leaves_complete_frames() -> Outcome {
    let folder = tempfile::tempdir()?;
    let out = folder.path().join("out");
    // A folder in place of the third frame's file.
    fs::create_dir_all(out.join("particles/particles_0002.ply/x"))?;
    let outcome = run(request(&out)?, &mut (), &|| Stop::No)?;
    let RunEnd::Failed(RunError::Io(error)) = &outcome.end else { panic!("{outcome:?}") };
    assert!(error.to_string().contains("particles_0002.ply"), "{error}");
    assert_eq!(outcome.complete_frames, 2);
    let report = fs::read_to_string(outcome.folder.report())?;
    assert!(report.contains("\"failed\"") && report.contains("particles_0002.ply"), "{report}");
    Ok(())
}

#[test]
fn pictures_of_the_surface_require_a_surface() -> Outcome {
    let folder = tempfile::tempdir()?;
    let mut settings = settings();
    settings.surface = false;
    settings.pictures = Some(vec![PictureKind::Surface]);
    let mut request = RunRequest::new(Scene::parse(SCENE, "small.toml")?, settings);
    request.out = Some(folder.path().join("out"));
    assert!(matches!(Session::start(request, &mut ()), Err(RunError::SurfaceRequired)));
    assert!(!folder.path().join("out").exists());
    Ok(())
}

#[test]
fn droplets_that_no_file_contains_are_reported_once() -> Outcome {
    let folder = tempfile::tempdir()?;
    let warnings = |scene: &str, formats: &[Format]| -> Result<Vec<String>, Box<dyn std::error::Error>> {
        let mut settings = settings();
        settings.formats = Some(formats.to_vec());
        let mut request = RunRequest::new(Scene::parse(scene, "small.toml")?, settings);
        request.out = Some(folder.path().join("out"));
        let mut log = Log::default();
        assert_finished(&run(request, &mut log, &|| Stop::No)?);
        Ok(log.warnings.into_iter().filter(|text| text.contains("droplets")).collect())
    };
    // One particle far from the water is a droplet.
    let drop = format!("{SCENE}[[fluid.block]]\nposition = [0.7, 0.5, 0.1]\nsize = [0.05, 0.05, 0.05]\n");
    let lost = warnings(&drop, &[Format::Obj])?;
    assert!(lost.len() == 1 && lost[0].contains("glb"), "{lost:?}");
    assert_eq!(warnings(&drop, &[Format::Stl, Format::Obj])?.len(), 1);
    // Controls: without droplets, with a file of points, and with droplets in the mesh.
    assert_eq!(warnings(SCENE, &[Format::Obj])?, [""; 0]);
    assert_eq!(warnings(&drop, &[Format::Obj, Format::Glb])?, [""; 0]);
    let whole = format!("{drop}[surface]\nmin_blob = 0\nmin_neighbours = 0\n");
    assert_eq!(warnings(&whole, &[Format::Obj])?, [""; 0]);
    Ok(())
}

#[test]
fn meshes_are_written_without_their_surfaces_at_walls_on_request() -> Outcome {
    let folder = tempfile::tempdir()?;
    // The number of triangles in the floor, in all, and the problems of the frames.
    let written = |keys: &str| -> Result<(usize, usize, Vec<String>), Box<dyn std::error::Error>> {
        let mut settings = settings();
        settings.formats = Some(vec![Format::Obj]);
        let scene = Scene::parse(&format!("{SCENE}[surface]\n{keys}\n"), "small.toml")?;
        let mut request = RunRequest::new(scene, settings);
        let out = folder.path().join("out");
        request.out = Some(out.clone());
        assert_finished(&run(request, &mut (), &|| Stop::No)?);
        let mesh = splashdown_io::read_mesh(&out.join("mesh/surface_0004.obj"))?;
        let is_in_floor = |t: &&[u32; 3]| t.iter().all(|&vertex| mesh.vertices[vertex as usize][1] == 0.0);
        let in_floor = mesh.triangles.iter().filter(is_in_floor).count();
        let problems = RunFrames::open(&out, None)?.problems().collect();
        Ok((in_floor, mesh.triangles.len(), problems))
    };
    let (in_floor, all, problems) = written("")?;
    assert!(in_floor > 50 && problems.is_empty(), "{in_floor} of {all}: {problems:?}");
    let (in_floor, rest, problems) = written("caps = false")?;
    assert!(in_floor == 0 && rest > all / 5 && rest < all, "{in_floor} of {rest}");
    assert!(problems.len() == 1 && problems[0].contains("surface.caps"), "{problems:?}");
    Ok(())
}
