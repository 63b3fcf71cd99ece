//! Runs that end early: by a signal, a full disk, or a file that cannot be written. `--resume` finishes them.

use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;

use crate::place::{Outcome, Place, assert_refused, can_draw, names, stderr};

/// The small scene with a probe, and with scene files only.
fn scene_files(place: &Place) -> std::io::Result<()> {
    let scene = fs::read_to_string(place.path("small.toml"))?;
    let probe = "\n[[probe]]\nname = \"level\"\nquantity = \"height\"\nposition = [0.2, 0, 0.1]\n";
    place.write("small.toml", format!("{scene}formats = [\"usd\", \"glb\"]\n{probe}")).map(drop)
}

/// The number of frames of the surface in `scene.glb`.
fn surfaces(place: &Place) -> Result<usize, Box<dyn std::error::Error>> {
    let bytes = fs::read(place.path("out/scene.glb"))?;
    let length = u32::from_le_bytes(bytes[12..16].try_into()?) as usize;
    let scene: Value = serde_json::from_slice(&bytes[20..20 + length])?;
    let names = scene["nodes"].as_array().into_iter().flatten().filter_map(|node| node["name"].as_str());
    Ok(names.filter(|name| name.starts_with("surface_")).count())
}

fn start(place: &Place, more: &[&str]) -> std::io::Result<Child> {
    let run = ["run", "small.toml", "--out", "out", "--device", "cpu", "--no-pictures"];
    Command::new(assert_cmd::cargo::cargo_bin!("splashdown"))
        .current_dir(place.path("."))
        .args(run)
        .args(more)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
}

/// Waits for a file.
fn wait_for(path: &Path) {
    let begun = Instant::now();
    while !path.exists() {
        assert!(begun.elapsed() < Duration::from_secs(60), "{} did not appear", path.display());
        std::thread::sleep(Duration::from_millis(2));
    }
}

fn report(place: &Place) -> Result<Value, Box<dyn std::error::Error>> {
    Ok(serde_json::from_slice(&fs::read(place.path("out/run.json"))?)?)
}

/// All files below a folder that belong to no user: hidden ones and those with unusual endings.
fn temporary_files(place: &Place) -> Result<Vec<String>, Box<dyn std::error::Error>> {
    let mut found = Vec::new();
    for folder in ["out", "out/particles", "out/mesh", "out/checkpoints", "out/pictures"] {
        let names = names(&place.path(folder)).unwrap_or_default();
        found.extend(names.into_iter().filter(|name| name.starts_with('.') || name.ends_with(".partial")));
    }
    Ok(found)
}

#[test]
fn a_killed_run_continues_its_scene_files() -> Outcome {
    let place = Place::new()?;
    scene_files(&place)?;
    let options = ["--frames", "12", "--checkpoint-every", "2"];
    let whole = ["run", "small.toml", "--out", "uninterrupted", "--device", "cpu", "--no-pictures"];
    let output = place.splashdown(&[&whole[..], &options].concat()).output()?;
    assert!(output.status.success(), "{}", stderr(&output));

    let mut run = start(&place, &options)?;
    wait_for(&place.path("out/checkpoints/checkpoint_0004.splashdown"));
    run.kill()?;
    run.wait()?;
    assert_eq!(report(&place)?["status"], "running");
    assert!(!place.path("out/particles.usdc").exists());
    // The data of the scene files is next to the checkpoint that needs it. Nothing else remains.
    assert!(place.path("out/checkpoints/particles.scenepart").exists());
    if cfg!(target_os = "linux") {
        assert_eq!(temporary_files(&place)?, Vec::<String>::new());
    }
    // A kill in the middle of an array.
    let part = place.path("out/checkpoints/particles.scenepart");
    let mut bytes = fs::read(&part)?;
    bytes.extend_from_slice(b"SPLD\0\0\x01\0");
    fs::write(&part, bytes)?;

    let output = place.splashdown(&["run", "--resume", "out"]).output()?;
    assert!(output.status.success(), "{}", stderr(&output));
    for file in ["particles.usdc", "scene.usdc", "scene.glb", "probes/level.csv"] {
        let [whole, resumed] = ["uninterrupted", "out"].map(|root| fs::read(place.path(root).join(file)));
        assert!(whole? == resumed?, "{file} differs");
    }
    assert_eq!(report(&place)?["status"], "finished");
    assert!(names(&place.path("out/checkpoints"))?.iter().all(|name| name.ends_with(".splashdown")));
    // The complete files are continued, too.
    let output = place.splashdown(&["run", "--resume", "out", "--frames", "14"]).output()?;
    assert!(output.status.success(), "{}", stderr(&output));
    assert_eq!(surfaces(&place)?, 15);
    assert_eq!(names(&place.path("out"))?.iter().filter(|name| name.ends_with(".usdc")).count(), 2);
    Ok(())
}

/// Without the surface the scene has other objects, so that its files cannot be continued.
#[test]
fn scene_data_that_cannot_be_continued_is_kept() -> Outcome {
    let place = Place::new()?;
    scene_files(&place)?;
    let mut run = start(&place, &["--frames", "12", "--checkpoint-every", "2"])?;
    wait_for(&place.path("out/checkpoints/checkpoint_0004.splashdown"));
    run.kill()?;
    run.wait()?;
    let output = place.splashdown(&["run", "--resume", "out", "--no-surface"]).output()?;
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(place.path("out/checkpoints/scene.scenepart.old").exists());
    assert!(
        names(&place.path("out"))?.iter().any(|name| name.starts_with("scene_00") && name.ends_with(".usdc"))
    );
    // Nothing is left to do.
    let output = place.splashdown(&["run", "--resume", "out"]).output()?;
    assert_refused(&output, 2, &["frame 12 is already complete"]);
    Ok(())
}

#[test]
fn a_run_without_its_scene_file_is_finished() -> Outcome {
    let place = Place::new()?;
    scene_files(&place)?;
    // A folder in the place of the file makes its last write fail, as a full disk does.
    fs::create_dir_all(place.path("out/scene.usdc"))?;
    let output = place.run_small(&["--frames", "4", "--checkpoint-every", "4"]).output()?;
    assert_refused(&output, 5, &["scene.usdc"]);
    assert_eq!(report(&place)?["status"], "failed");
    fs::remove_dir(place.path("out/scene.usdc"))?;
    let output = place.splashdown(&["run", "--resume", "out"]).output()?;
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(fs::read(place.path("out/scene.usdc"))?.starts_with(b"PXR-USDC"));
    assert_eq!(surfaces(&place)?, 5);
    assert_eq!(report(&place)?["status"], "finished");
    assert_eq!(report(&place)?["complete_frames"], 5);
    // Nothing is left to do, which is an error as before.
    let output = place.splashdown(&["run", "--resume", "out"]).output()?;
    assert_refused(&output, 2, &["frame 4 is already complete", "--frames"]);
    Ok(())
}

#[test]
#[cfg(target_os = "linux")]
fn a_run_on_a_full_disk_is_finished_when_there_is_space() -> Outcome {
    let place = Place::new()?;
    scene_files(&place)?;
    let Some(disk) = crate::place::TinyDisk::mount(place.path("disk"), 24_576)? else {
        eprintln!("SKIPPED: no small file system can be mounted");
        return Ok(());
    };
    let run = ["run", "small.toml", "--out", "disk/out", "--device", "cpu", "--no-pictures"];
    let run = [&run[..], &["--frames", "24", "--checkpoint-every", "24"]].concat();
    // How much data the run writes before the scene files, and in total.
    let output = place.splashdown(&run).output()?;
    assert!(output.status.success(), "{}", stderr(&output));
    let size = |name: &str| fs::metadata(disk.0.join(name)).map(|data| data.len());
    let whole = || -> std::io::Result<u64> {
        ["particles.usdc", "scene.usdc", "scene.glb"].iter().map(|name| size(&format!("out/{name}"))).sum()
    };
    let scenes = whole()?;
    let checkpoint = size("out/checkpoints/checkpoint_0024.splashdown")?;
    fs::remove_dir_all(disk.0.join("out"))?;
    // Room for the data and the checkpoint, but not for all the scene files.
    let room = scenes + checkpoint + 160 * 1024;
    fs::write(disk.0.join("filler"), vec![0; 24_576 * 1024 - room as usize])?;
    let output = place.splashdown(&run).output()?;
    assert_refused(&output, 5, &["full"]);
    let checkpoint = disk.0.join("out/checkpoints/checkpoint_0024.splashdown");
    assert!(checkpoint.exists(), "{} bytes of scene files: {}", scenes, stderr(&output));
    fs::remove_file(disk.0.join("filler"))?;
    let output = place.splashdown(&["run", "--resume", "disk/out"]).output()?;
    assert!(output.status.success(), "{}", stderr(&output));
    assert_eq!(whole()?, scenes);
    Ok(())
}

#[test]
fn a_missing_film_is_made_from_the_pictures() -> Outcome {
    if !can_draw() {
        return Ok(());
    }
    if Command::new("ffmpeg").arg("-version").output().is_err() {
        eprintln!("SKIPPED: ffmpeg is not installed");
        return Ok(());
    }
    let place = Place::new()?;
    let run =
        ["run", "small.toml", "--out", "out", "--device", "cpu", "--frames", "3", "--checkpoint-every", "3"];
    let output = place.splashdown(&[&run[..], &["--pictures", "surface"]].concat()).output()?;
    assert!(output.status.success(), "{}", stderr(&output));
    let film = place.path("out/surface.mp4");
    let bytes = fs::read(&film)?;
    // As after a kill while the film is encoded.
    fs::remove_file(&film)?;
    let text = fs::read_to_string(place.path("out/run.json"))?;
    fs::write(place.path("out/run.json"), text.replace("\"finished\"", "\"running\""))?;
    let output = place.splashdown(&["run", "--resume", "out"]).output()?;
    assert!(output.status.success(), "{}", stderr(&output));
    assert_eq!(fs::read(&film)?.len(), bytes.len());
    assert_eq!(report(&place)?["status"], "finished");
    // Only the film is missing.
    fs::remove_file(&film)?;
    let output = place.splashdown(&["run", "--resume", "out"]).output()?;
    assert!(output.status.success() && film.exists(), "{}", stderr(&output));
    Ok(())
}

#[test]
fn a_probe_table_that_is_too_short_is_reported() -> Outcome {
    let place = Place::new()?;
    scene_files(&place)?;
    let output = place.run_small(&["--frames", "2", "--checkpoint-every", "2"]).output()?;
    assert!(output.status.success(), "{}", stderr(&output));
    let table = place.path("out/probes/level.csv");
    let text = fs::read_to_string(&table)?;
    let rows: Vec<&str> = text.lines().collect();
    // The last row is cut in half.
    fs::write(&table, &text[..text.trim_end().len() - 2])?;
    let output = place.splashdown(&["run", "--resume", "out", "--frames", "3"]).output()?;
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(
        stderr(&output).contains("level.csv") && stderr(&output).contains("incomplete"),
        "{}",
        stderr(&output)
    );
    let resumed = fs::read_to_string(&table)?;
    assert!(resumed.starts_with(&rows[..rows.len() - 1].join("\n")), "complete rows remain: {resumed}");
    // Control: a complete table is not reported.
    let intact = Place::new()?;
    scene_files(&intact)?;
    assert!(intact.run_small(&["--frames", "2", "--checkpoint-every", "2"]).output()?.status.success());
    let output = intact.splashdown(&["run", "--resume", "out", "--frames", "3"]).output()?;
    assert!(output.status.success() && !stderr(&output).contains("probe table"), "{}", stderr(&output));
    Ok(())
}

#[test]
fn two_complete_checkpoints_exist_at_any_time() -> Outcome {
    let place = Place::new()?;
    let mut run = start(&place, &["--frames", "40", "--checkpoint-every", "1"])?;
    wait_for(&place.path("out/checkpoints/checkpoint_0002.splashdown"));
    let mut looks = 0;
    while run.try_wait()?.is_none() {
        // The folder changes while it is listed: a removed file may be missing that a later list would not miss.
        let lists = [(); 2].map(|()| names(&place.path("out/checkpoints")).unwrap_or_default());
        let most = lists.iter().map(Vec::len).max().unwrap_or(0);
        assert!(most >= 2, "{lists:?}");
        looks += 1;
    }
    assert!(looks > 3, "{looks}");
    assert_eq!(names(&place.path("out/checkpoints"))?.len(), 2);
    Ok(())
}

/// Sends a signal to a run that was started with SIGHUP ignored or not; returns the status in its report.
#[cfg(unix)]
fn status_after_hangup(ignored: bool) -> Result<Value, Box<dyn std::error::Error>> {
    let place = Place::new()?;
    let program = assert_cmd::cargo::cargo_bin!("splashdown");
    let trap = if ignored { "trap '' HUP; " } else { "" };
    let run = "run small.toml --out out --device cpu --no-pictures --frames 60";
    let mut shell = Command::new("sh")
        .current_dir(place.path("."))
        .arg("-c")
        .arg(format!("{trap}exec '{}' {run} >/dev/null 2>&1", program.display()))
        .spawn()?;
    wait_for(&place.path("out/particles/particles_0003.ply"));
    let sent = Command::new("kill").args(["-HUP", &shell.id().to_string()]).status()?;
    assert!(sent.success());
    shell.wait()?;
    Ok(report(&place)?["status"].clone())
}

#[test]
#[cfg(unix)]
fn an_ignored_hangup_does_not_stop_a_run() -> Outcome {
    assert_eq!(status_after_hangup(true)?, "finished");
    // Control: otherwise it does.
    assert_eq!(status_after_hangup(false)?, "interrupted");
    Ok(())
}
