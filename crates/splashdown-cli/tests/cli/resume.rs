//! Resuming a run: the accepted paths, the reported changes, and the lock of the output folder.

use std::fs;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;
use splashdown_io::Archive;

use crate::place::{Outcome, Place, assert_refused, stderr};

/// A finished run of two frames in `out`, with a checkpoint after each.
fn two_frames() -> Result<Place, Box<dyn std::error::Error>> {
    let place = Place::new()?;
    let output = place.run_small(&["--frames", "2", "--checkpoint-every", "1"]).output()?;
    assert!(output.status.success(), "{}", stderr(&output));
    Ok(place)
}

/// Changes an entry of the newest checkpoint.
fn change(place: &Place, entry: &str, new: impl Fn(&str) -> String) -> Outcome {
    let path = place.path("out/checkpoints/checkpoint_0002.splashdown");
    let mut archive = Archive::read(&path)?;
    let text = new(archive.text(entry)?);
    archive.set_text(entry, &text);
    archive.write(&path)?;
    Ok(())
}

#[test]
fn two_runs_do_not_write_into_one_folder() -> Outcome {
    let place = Place::new()?;
    let mut first = Command::new(assert_cmd::cargo::cargo_bin!("splashdown"))
        .current_dir(place.path("."))
        .args(["run", "small.toml", "--out", "out", "--device", "cpu", "--no-pictures", "--frames", "99999"])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()?;
    let begun = Instant::now();
    while !place.path("out/run.json").exists() && begun.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(5));
    }
    let refused = place.run_small(&[]).output()?;
    // A run in another folder is accepted.
    let other =
        place.splashdown(&["run", "small.toml", "--out", "b", "-d", "cpu", "--no-pictures"]).output()?;
    first.kill()?;
    first.wait()?;
    assert_refused(&refused, 2, &["another run is writing into `out`", "--out"]);
    assert!(other.status.success(), "{}", stderr(&other));
    // An incomplete file of the killed run is removed with its frames.
    let partial = place.write("out/particles/.particles_0007.ply.1-2.partial", "ply")?;
    // The lock file of a killed run does not lock, and a finished run removes its lock file.
    let output = place.run_small(&[]).output()?;
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(!place.path("out/.lock").exists() && !partial.exists());
    Ok(())
}

#[test]
fn a_run_is_found_by_its_checkpoint_folder_or_a_file_in_it() -> Outcome {
    let place = two_frames()?;
    let named = ["out/checkpoints", "out/checkpoints/", "out/checkpoints/checkpoint_0004.splashdown"];
    for (name, frames) in named.iter().zip(["3", "4", "5"]) {
        let output = place.splashdown(&["run", "--resume", name, "--frames", frames]).output()?;
        assert!(output.status.success(), "{name}: {}", stderr(&output));
        assert!(place.path(&format!("out/particles/particles_000{frames}.ply")).exists(), "{name}");
    }
    // From inside the folder of checkpoints.
    let mut inside = place.splashdown(&["run", "--resume", ".", "--frames", "6"]);
    let output = inside.current_dir(place.path("out/checkpoints")).output()?;
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(place.path("out/particles/particles_0006.ply").exists());
    // A copied checkpoint is outside the folder of a run; its file must be named.
    fs::create_dir(place.path("copies"))?;
    fs::copy(place.path("out/checkpoints/checkpoint_0006.splashdown"), place.path("copies/mine.splashdown"))?;
    let output = place.splashdown(&["run", "--resume", "copies"]).output()?;
    assert_refused(&output, 5, &["as in `copies/mine.splashdown`"]);
    Ok(())
}

#[test]
fn a_change_of_the_device_is_reported() -> Outcome {
    let place = two_frames()?;
    let longer = |frames: &str, more: &[&str]| {
        place.splashdown(&[&["run", "--resume", "out", "--frames", frames], more].concat()).output()
    };
    let requested_device = |frame: u32| -> Result<Value, Box<dyn std::error::Error>> {
        let archive =
            Archive::read(&place.path(&format!("out/checkpoints/checkpoint_000{frame}.splashdown")))?;
        Ok(serde_json::from_str::<Value>(archive.text("notes.json")?)?["device"].clone())
    };
    change(&place, "about.json", |text| text.replace("\"CPU\"", "\"Abacus\""))?;
    let output = longer("3", &[])?;
    assert!(stderr(&output).contains("made on Abacus, and the run continues on CPU"), "{}", stderr(&output));
    assert_eq!(requested_device(3)?, "cpu");
    // Control: the same device is not reported.
    let output = longer("4", &["--device", "auto"])?;
    assert!(output.status.success(), "{}", stderr(&output));
    assert_eq!(requested_device(4)?, "auto");
    if stderr(&output).contains("on CPU (") {
        assert!(!stderr(&output).contains("was made on"), "{}", stderr(&output));
    }
    Ok(())
}

#[test]
fn missing_files_are_reported_and_existing_files_are_counted() -> Outcome {
    let place = Place::new()?;
    let report = |root: &str| -> Result<Value, Box<dyn std::error::Error>> {
        Ok(serde_json::from_slice(&fs::read(place.path(root).join("run.json"))?)?)
    };
    let run = ["run", "small.toml", "--device", "cpu", "--no-pictures", "--checkpoint-every", "1"];
    for (root, frames) in [("uninterrupted", "4"), ("out", "2")] {
        let output = place.splashdown(&[&run[..], &["--out", root, "--frames", frames]].concat()).output()?;
        assert!(output.status.success(), "{}", stderr(&output));
    }
    let output = place.splashdown(&["run", "--resume", "out", "--frames", "4"]).output()?;
    assert!(!stderr(&output).contains("cannot be found"), "{}", stderr(&output));
    // Five frames of particles, droplets and surface, two checkpoints.
    assert_eq!(report("uninterrupted")?["files"], 17);
    assert_eq!(report("out")?["files"], 17);

    // From here on other formats are requested. Earlier frames do not have them, and no warning appears.
    let longer = |frames: &str, more: &[&str]| {
        place.splashdown(&[&["run", "--resume", "out", "--frames", frames], more].concat()).output()
    };
    let output = longer("5", &["--formats", "ply,vtk"])?;
    assert!(!stderr(&output).contains("cannot be found"), "{}", stderr(&output));
    let output = longer("6", &[])?;
    assert!(!stderr(&output).contains("cannot be found"), "{}", stderr(&output));
    fs::remove_file(place.path("out/particles/particles_0006.vtk"))?;
    let output = longer("7", &[])?;
    assert!(output.status.success(), "{}", stderr(&output));
    let warning = "1 file of earlier frames cannot be found: particles/particles_0006.vtk";
    assert!(stderr(&output).contains(warning), "{}", stderr(&output));
    Ok(())
}

#[test]
fn invalid_notes_in_a_checkpoint_are_refused() -> Outcome {
    let place = two_frames()?;
    let wrong = [
        ("words", "notes.json"),
        ("{\"frames\": 0}", "`frames`"),
        ("{\"checkpoint_every\": 4000000000}", "`checkpoint_every`"),
        ("{\"digits\": 99}", "`digits`"),
        ("{\"formats\": [\"ply\", \"abc\"]}", "\"abc\""),
        ("{\"pictures\": [\"ply\"]}", "\"ply\""),
    ];
    for (notes, word) in wrong {
        change(&place, "notes.json", |_| notes.to_owned())?;
        let newest = "out/checkpoints/checkpoint_0002.splashdown";
        let output = place.splashdown(&["run", "--resume", newest, "--frames", "3"]).output()?;
        assert_refused(&output, 5, &["checkpoint_0002", "notes.json", word]);
    }
    // The previous checkpoint is used.
    let output = place.splashdown(&["run", "--resume", "out"]).output()?;
    assert!(output.status.success() && stderr(&output).contains("skipped"), "{}", stderr(&output));
    Ok(())
}

/// Each reason why the window does not open has its own message and exit code.
#[test]
#[cfg(all(feature = "window", target_os = "linux"))]
fn the_window_reports_a_checkpoint_or_a_display_that_cannot_be_used() -> Outcome {
    let place = two_frames()?;
    let newest = "out/checkpoints/checkpoint_0002.splashdown";
    let view = |what: &str, display: &str| {
        let mut command = place.splashdown(&["view", what]);
        for variable in ["WAYLAND_DISPLAY", "WAYLAND_SOCKET"] {
            command.env_remove(variable);
        }
        command.env("DISPLAY", display).output()
    };
    assert_refused(&view("small.toml", "")?, 4, &["no display", "splashdown run"]);
    // No display has this number.
    let output = view("small.toml", ":6346")?;
    assert_refused(&output, 4, &["DISPLAY"]);
    assert!(!stderr(&output).contains("driver"), "{}", stderr(&output));
    // The checkpoint is checked before the display.
    assert_refused(&view(newest, "")?, 4, &["no display"]);
    let path = place.path(newest);
    let mut archive = Archive::read(&path)?;
    archive.set_array("ids", &[1_u32, 2], 1);
    archive.write(&path)?;
    let output = view(newest, "")?;
    assert_refused(&output, 5, &["checkpoint", "ids"]);
    assert!(!stderr(&output).contains("driver"), "{}", stderr(&output));
    Ok(())
}

/// A folder with frames is played; its scene must be known.
#[test]
#[cfg(all(feature = "window", target_os = "linux"))]
fn the_window_plays_a_run_whose_scene_is_known() -> Outcome {
    let place = two_frames()?;
    let view = |arguments: &[&str]| {
        let mut command = place.splashdown(&[&["view"], arguments].concat());
        for variable in ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"] {
            command.env_remove(variable);
        }
        command.output()
    };
    for folder in ["out", "out/checkpoints"] {
        assert_refused(&view(&[folder])?, 4, &["no display"]);
    }
    fs::remove_dir_all(place.path("out/checkpoints"))?;
    fs::remove_file(place.path("out/run.json"))?;
    assert_refused(&view(&["out"])?, 2, &["run.json", "--scene FILE"]);
    assert_refused(&view(&["out", "--scene", "small.toml"])?, 4, &["no display"]);
    assert_refused(&view(&["small.toml", "--scene", "small.toml"])?, 2, &["--scene", "small.toml"]);
    Ok(())
}
