//! Stopping a run by a signal, by Ctrl-C and by a full disk, and resuming it.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use crate::place::{Outcome, Place, SMALL, TinyDisk, assert_refused, stderr, stdout};

/// The small scene with probes and a dynamic body, which have state of their own.
const MORE: &str = "
[[probe]]
name = \"gauge\"
quantity = \"pressure\"
position = [0, 0.05, 0.15]

[[probe]]
name = \"motion\"
quantity = \"body\"
body = \"ball\"

[[body]]
name = \"ball\"
mesh = \"sphere\"
scale = 0.1
position = [0.6, 0.2, 0.15]
motion = \"dynamic\"
density = 500
";

/// The files of a run by name. The report is excluded because it contains wall times, and so are the checkpoints.
fn results(root: &Path) -> std::io::Result<BTreeMap<String, Vec<u8>>> {
    let mut found = BTreeMap::new();
    for folder in ["particles", "mesh", "probes", "bodies"] {
        for entry in fs::read_dir(root.join(folder))? {
            let path = entry?.path();
            let name = path.strip_prefix(root).unwrap_or(&path).display().to_string();
            found.insert(name, fs::read(&path)?);
        }
    }
    Ok(found)
}

fn assert_same(resumed: &Path, uninterrupted: &Path) -> Outcome {
    let (resumed, uninterrupted) = (results(resumed)?, results(uninterrupted)?);
    assert_eq!(resumed.keys().collect::<Vec<_>>(), uninterrupted.keys().collect::<Vec<_>>());
    for (name, bytes) in &resumed {
        assert!(*bytes == uninterrupted[name], "{name} differs from that of the uninterrupted run");
    }
    Ok(())
}

fn start(place: &Place, arguments: &[&str]) -> std::io::Result<Child> {
    Command::new(assert_cmd::cargo::cargo_bin!("splashdown"))
        .current_dir(place.path("."))
        .args(arguments)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
}

/// Waits until this file exists.
fn await_file(path: &Path) {
    let begun = Instant::now();
    while !path.exists() {
        assert!(begun.elapsed() < Duration::from_secs(60), "{} did not appear", path.display());
        std::thread::sleep(Duration::from_millis(2));
    }
}

#[test]
fn a_killed_run_resumes_bit_identically() -> Outcome {
    let place = Place::new()?;
    place.write("more.toml", format!("{SMALL}{MORE}"))?;
    let run = [
        "run",
        "more.toml",
        "--device",
        "cpu",
        "--no-pictures",
        "--formats",
        "ply,vtu,vtp",
        "--frames",
        "40",
    ];
    let output = place.splashdown(&[&run[..], &["--out", "uninterrupted"]].concat()).output()?;
    assert!(output.status.success(), "{}", stderr(&output));

    // The run is killed three times, at arbitrary points.
    let mut child = start(&place, &[&run[..], &["--out", "out", "--checkpoint-every", "1"]].concat())?;
    for frame in [5, 12, 20] {
        await_file(&place.path(&format!("out/checkpoints/checkpoint_{frame:04}.splashdown")));
        child.kill()?;
        child.wait()?;
        child = start(&place, &["run", "--resume", "out"])?;
    }
    assert!(child.wait()?.success());
    assert_same(&place.path("out"), &place.path("uninterrupted"))?;
    for index in ["particles/particles.pvd", "mesh/surface.pvd"] {
        assert_eq!(fs::read_to_string(place.path("out").join(index))?.matches("<DataSet ").count(), 41);
    }

    // The last two checkpoints remain, and no incomplete file.
    let mut names: Vec<_> = fs::read_dir(place.path("out/checkpoints"))?
        .map(|entry| entry.map(|entry| entry.file_name().to_string_lossy().into_owned()))
        .collect::<Result<_, _>>()?;
    names.sort();
    assert_eq!(names, ["checkpoint_0039.splashdown", "checkpoint_0040.splashdown"]);

    // A finished run can be extended.
    let output = place.splashdown(&["run", "--resume", "out", "--frames", "41"]).output()?;
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(place.path("out/particles/particles_0041.ply").exists());
    // Control: the extended run has more files.
    assert!(results(&place.path("out"))?.len() > results(&place.path("uninterrupted"))?.len());
    Ok(())
}

#[test]
fn ctrl_c_writes_a_checkpoint_and_prints_how_to_resume() -> Outcome {
    let place = Place::new()?;
    let child = Command::new(assert_cmd::cargo::cargo_bin!("splashdown"))
        .current_dir(place.path("."))
        .args(["run", "small.toml", "--device", "cpu", "--no-pictures", "--frames", "9999", "--out", "out"])
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()?;
    await_file(&place.path("out/particles/particles_0003.ply"));
    Command::new("kill").args(["-INT", &child.id().to_string()]).status()?;
    let output = child.wait_with_output()?;
    assert_eq!(output.status.code(), Some(130));
    assert!(stdout(&output).contains("splashdown run --resume out"), "{}", stdout(&output));
    let frames = fs::read_dir(place.path("out/particles"))?.count();
    let last = frames.to_string();
    let output = place.splashdown(&["run", "--resume", "out", "--frames", &last]).output()?;
    assert!(output.status.success(), "{}", stderr(&output));
    assert_eq!(fs::read_dir(place.path("out/particles"))?.count(), frames + 1);
    Ok(())
}

#[test]
fn a_run_stopped_by_a_full_disk_resumes_when_space_is_available() -> Outcome {
    let place = Place::new()?;
    let Some(disk) = TinyDisk::mount(place.path("disk"), 256)? else {
        eprintln!("SKIPPED: a small file system cannot be mounted");
        return Ok(());
    };
    let run = ["run", "small.toml", "--device", "cpu", "--no-pictures", "--no-surface", "--frames", "40"];
    let output = place.splashdown(&[&run[..], &["--out", "uninterrupted"]].concat()).output()?;
    assert!(output.status.success(), "{}", stderr(&output));
    let output =
        place.splashdown(&[&run[..], &["--out", "disk/out", "--checkpoint-every", "2"]].concat()).output()?;
    assert_refused(&output, 5, &["disk is full", "--resume disk/out"]);
    let enlarge = ["-o", "remount,size=4m"];
    assert!(Command::new("mount").args(enlarge).arg(&disk.0).status()?.success());
    let output = place.splashdown(&["run", "--resume", "disk/out"]).output()?;
    assert!(output.status.success(), "{}", stderr(&output));
    for frame in [0, 7, 40] {
        let name = format!("particles/particles_{frame:04}.ply");
        let read = |root: &str| fs::read(place.path(root).join(&name));
        assert!(read("disk/out")? == read("uninterrupted")?, "{name}");
    }
    Ok(())
}

#[test]
fn unusable_paths_and_checkpoints_are_refused() -> Outcome {
    let place = Place::new()?;
    let resume = |what: &str| place.splashdown(&["run", "--resume", what]).output();
    assert_refused(&resume("nowhere")?, 5, &["nowhere"]);
    fs::create_dir(place.path("empty"))?;
    assert_refused(&resume("empty")?, 5, &["empty", "--checkpoint-every"]);
    assert_refused(&resume("small.toml")?, 5, &["small.toml", "not a usable checkpoint"]);
    let both = place.splashdown(&["run", "small.toml", "--resume", "out"]).output()?;
    assert_refused(&both, 2, &["cannot be used with"]);
    assert_refused(&place.splashdown(&["run"]).output()?, 2, &["SCENE"]);

    // A finished run is not restarted, also if another spelling names its folder.
    let done = place.run_small(&["--checkpoint-every", "1"]).output()?;
    assert!(done.status.success(), "{}", stderr(&done));
    let shorter =
        place.splashdown(&["run", "--resume", "out", "--out", "./out", "--frames", "2"]).output()?;
    assert_refused(&shorter, 2, &["frame 2 is already complete", "--frames"]);
    let longer = place.splashdown(&["run", "--resume", "out", "--out", "./out", "--frames", "3"]).output()?;
    assert!(longer.status.success() && stderr(&longer).contains("after frame 2"), "{}", stderr(&longer));
    for frame in 0..=3 {
        assert!(place.path(&format!("out/particles/particles_000{frame}.ply")).exists(), "frame {frame}");
    }

    // A truncated checkpoint given as a file is refused. Given its folder, the previous checkpoint is used.
    let output = place.run_small(&["--frames", "4", "--checkpoint-every", "2"]).output()?;
    assert!(output.status.success(), "{}", stderr(&output));
    let newest = place.path("out/checkpoints/checkpoint_0004.splashdown");
    let bytes = fs::read(&newest)?;
    fs::write(&newest, &bytes[..bytes.len() / 2])?;
    assert_refused(&resume("out/checkpoints/checkpoint_0004.splashdown")?, 5, &["cut short"]);
    let output = resume("out")?;
    assert!(output.status.success() && stderr(&output).contains("skipped"), "{}", stderr(&output));
    assert!(fs::read(&newest)? == bytes, "the checkpoint is written again");
    Ok(())
}
