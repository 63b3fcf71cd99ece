//! Invalid input: each case gives one clear error and its exit code, and frames already written stay valid.

use std::io::Write;

use crate::place::{Outcome, Place, SMALL, assert_refused, can_draw, lines, stderr, stdout};
use splashdown_io::ply;

/// Scene files that are refused with exit code 3, and a word in the message.
fn wrong_scenes() -> Vec<(&'static str, Vec<u8>, &'static str)> {
    let edit = |from: &str, to: &str| {
        assert!(SMALL.contains(from), "{from}");
        SMALL.replace(from, to).into_bytes()
    };
    vec![
        ("empty", Vec::new(), "scene"),
        ("comment only", b"# nothing\n".to_vec(), "fluid"),
        ("not TOML", b"[scene\nname = ".to_vec(), "1"),
        ("not text", vec![0xff, 0xfe, 0x00, 0x80], "text"),
        ("JSON", b"{\"scene\": {}}".to_vec(), "TOML"),
        ("NUL", b"[scene]\nname = \"a\0b\"\n".to_vec(), "text"),
        ("deeply nested", [b"x = ".as_slice(), &b"[".repeat(200_000)].concat(), "wrong.toml"),
        ("too long", vec![b'#'; 5 << 20], "MiB"),
        ("unknown key", edit("[fluid]", "[fluid]\nvolume = 3"), "volume"),
        ("wrong type", edit("duration = 0.01", "duration = \"long\""), "duration"),
        ("NaN", edit("duration = 0.01", "duration = nan"), "duration"),
        ("infinite", edit("0.05", "inf"), "particle_spacing"),
        ("huge", edit("max = [1, 1, 0.3]", "max = [1e300, 1, 0.3]"), "domain.max"),
        ("fluid outside", edit("position = [0, 0, 0]", "position = [5, 0, 0]"), "domain"),
        ("fluid partly outside", edit("size = [0.3, 0.3, 0.3]", "size = [0.3, 3, 0.3]"), "domain"),
        ("no block", edit("[[fluid.block]]\nposition = [0, 0, 0]\nsize = [0.3, 0.3, 0.3]\n", ""), "block"),
        ("no particle", edit("size = [0.3, 0.3, 0.3]", "size = [0.001, 0.001, 0.001]"), "particle"),
        ("a large blob", edit("[fluid]", "[surface]\nmin_blob = 33\n[fluid]"), "surface.min_blob"),
        ("half a neighbour", edit("[fluid]", "[surface]\nmin_neighbours = 2.5\n[fluid]"), "min_neighbours"),
        ("too many particles", edit("particle_spacing = 0.05", "particle_spacing = 0.0006"), "particles"),
        ("a name that leaves the output folder", edit("\"small\"", "\"../../x\""), "name"),
    ]
}

#[test]
fn wrong_scenes_are_refused_before_anything_is_written() -> Outcome {
    let place = Place::new()?;
    for (what, text, word) in wrong_scenes() {
        place.write("wrong.toml", text)?;
        for command in ["check", "run"] {
            let output = place.splashdown(&[command, "wrong.toml", "--device", "cpu"]).output()?;
            assert_eq!(output.status.code(), Some(3), "{what}: {}", stderr(&output));
            assert_refused(&output, 3, &["wrong.toml", word]);
            assert!(stderr(&output).len() < 20_000, "{what}: the message is too long");
        }
        assert!(!place.path("out").exists(), "{what}");
    }
    Ok(())
}

#[test]
fn a_missing_scene_and_a_folder_have_different_messages() -> Outcome {
    let place = Place::new()?;
    assert_refused(
        &place.splashdown(&["run", "nowhere.toml"]).output()?,
        3,
        &["nowhere.toml", "splashdown scenes"],
    );
    assert_refused(&place.splashdown(&["run", "dam-brake"]).output()?, 3, &["did you mean \"dam-break\""]);
    assert_refused(&place.splashdown(&["run", "."]).output()?, 3, &["folder"]);
    let json = place.splashdown(&["run", "nowhere.toml", "--json"]).output()?;
    assert_eq!(lines(&json)?[0]["exit_code"], 3);
    Ok(())
}

#[test]
fn a_hundred_million_particles_are_refused_with_advice() -> Outcome {
    let place = Place::new()?;
    // 500 x 500 x 400 particles of 1 mm.
    let scene = SMALL
        .replace("0.05", "0.001")
        .replace("size = [0.3, 0.3, 0.3]", "size = [0.5, 0.5, 0.4]")
        .replace("max = [1, 1, 0.3]", "max = [1, 1, 0.4]");
    place.write("huge.toml", scene)?;
    let output = place.splashdown(&["run", "huge.toml", "--device", "cpu", "--out", "out"]).output()?;
    assert!(matches!(output.status.code(), Some(3 | 4)), "{:?} {}", output.status, stderr(&output));
    assert!(stderr(&output).contains("particle_spacing"), "{}", stderr(&output));
    assert!(!stderr(&output).contains("panicked"));
    Ok(())
}

#[test]
fn unwritable_folders_are_reported_before_the_first_step() -> Outcome {
    let place = Place::new()?;
    place.write("file", "in the way")?;
    for out in ["file", "file/below"] {
        let output = place
            .splashdown(&["run", "small.toml", "--device", "cpu", "--no-pictures", "--out", out])
            .output()?;
        assert_refused(&output, 5, &["file"]);
    }
    Ok(())
}

#[test]
fn more_particles_than_fit_into_a_buffer_are_refused_with_the_largest_count() -> Outcome {
    let doctor = crate::place::splashdown(&["doctor"]).output()?;
    if !can_draw() || !stdout(&doctor).contains("llvmpipe") {
        let _ = writeln!(
            std::io::stderr(),
            "SKIPPED: more_particles_than_fit_into_a_buffer_are_refused_with_the_largest_count: there is no llvmpipe"
        );
        return Ok(());
    }
    let place = Place::new()?;
    let scene = "[scene]\nname = \"big\"\nduration = 1.0\n[domain]\nmin = [0, 0, 0]\nmax = [3, 2, 2]\n\
                 [fluid]\nparticle_spacing = 0.0093\n[[fluid.block]]\nposition = [0, 0, 0]\nsize = [2, 2, 2]\n\
                 [surface]\nenabled = false\n";
    place.write("big.toml", scene)?;
    let words = ["at most 8388608 fit", "134 MB", "particle_spacing of 0.0099 m"];
    for arguments in [&["run", "big.toml"][..], &["check", "big.toml"], &["bench", "--scene", "big.toml"]] {
        let output = place.splashdown(&[arguments, &["--device", "llvmpipe"]].concat()).output()?;
        assert_refused(&output, 4, &words);
    }
    // Control: the recommended spacing is accepted; `check` is enough to test that.
    place.write("big.toml", scene.replace("0.0093", "0.0099"))?;
    let output = place.splashdown(&["check", "big.toml", "--device", "llvmpipe"]).output()?;
    assert!(output.status.success(), "{}", stderr(&output));
    Ok(())
}

#[test]
fn unknown_devices_are_refused_with_the_available_names() -> Outcome {
    let place = Place::new()?;
    for command in ["run", "check"] {
        let output = place.splashdown(&[command, "small.toml", "--device", "no-such-card"]).output()?;
        assert_refused(&output, 4, &["no-such-card", "available"]);
    }
    assert_refused(
        &crate::place::splashdown(&["bench", "--device", "no-such-card"]).output()?,
        4,
        &["no-such-card"],
    );
    Ok(())
}

#[test]
fn a_refused_run_leaves_the_frames_of_an_earlier_one() -> Outcome {
    let place = Place::new()?;
    assert!(place.run_small(&[]).output()?.status.success());
    let earlier = crate::place::names(&place.path("out/particles"))?;
    assert_eq!(earlier.len(), 3);
    let run = |more: &[&str]| {
        place.splashdown(&[&["run", "small.toml", "--out", "out", "--no-pictures"], more].concat()).output()
    };
    assert_refused(&run(&["--device", "no-such-card"])?, 4, &["no-such-card"]);
    assert_refused(&run(&["--formats", "none,ply"])?, 2, &["none"]);
    assert_eq!(crate::place::names(&place.path("out/particles"))?, earlier);
    assert!(place.path("out/run.json").exists());
    // Control: a run that is not refused does replace them.
    assert!(run(&["--device", "cpu", "--frames", "1"])?.status.success());
    assert_eq!(crate::place::names(&place.path("out/particles"))?.len(), 2);
    Ok(())
}

#[test]
fn frames_before_a_failure_stay_valid() -> Outcome {
    let place = Place::new()?;
    // A folder in place of the third frame's file.
    std::fs::create_dir_all(place.path("out/particles/particles_0002.ply/x"))?;
    let output = place.run_small(&["--frames", "4", "--json"]).output()?;
    assert_refused(&output, 5, &["particles_0002.ply", "folder"]);
    for frame in 0..2 {
        let name = format!("out/particles/particles_000{frame}.ply");
        assert_eq!(ply::read_particles(&place.path(&name))?.len(), 216);
    }
    let lines = lines(&output)?;
    let reported: Vec<_> =
        lines.iter().filter(|line| line["event"] == "frame").map(|line| line["frame"].clone()).collect();
    assert_eq!(reported, [0, 1], "only complete frames are reported");
    assert_eq!(lines.last().map(|line| &line["exit_code"]), Some(&5.into()));
    let partial = crate::place::names(&place.path("out/particles"))?
        .into_iter()
        .filter(|name| name.contains("partial"))
        .count();
    assert_eq!(partial, 0);
    Ok(())
}

#[test]
fn a_closed_pipe_does_not_stop_the_run() -> Outcome {
    use std::process::{Command, Stdio};
    let place = Place::new()?;
    let mut command = Command::new(assert_cmd::cargo::cargo_bin!("splashdown"));
    command.current_dir(place.path(".")).args([
        "run",
        "small.toml",
        "--device",
        "cpu",
        "--no-pictures",
        "--json",
        "--out",
        "out",
    ]);
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn()?;
    drop(child.stdout.take());
    let output = child.wait_with_output()?;
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(!stderr(&output).contains("panicked"), "{}", stderr(&output));
    assert!(place.path("out/particles/particles_0002.ply").exists());
    Ok(())
}

#[cfg(target_os = "linux")]
mod linux {
    use crate::place::TinyDisk;
    use crate::place::{Outcome, Place, assert_refused, names, stderr, stdout};
    use splashdown_io::ply;
    use std::io::{BufRead, BufReader};
    use std::process::{Command, Stdio};

    #[test]
    fn without_a_driver_files_are_written_and_a_warning_says_what_to_install() -> Outcome {
        let place = Place::new()?;
        let run = |more: &[&str]| {
            let mut command = place.splashdown(&["run", "small.toml", "--out", "out", "--frames", "1"]);
            command
                .env("VK_DRIVER_FILES", "/nonexistent")
                .env("VK_ICD_FILENAMES", "/nonexistent")
                .args(more)
                .output()
        };
        let output = run(&[])?;
        assert!(output.status.success(), "{}", stderr(&output));
        let text = stderr(&output);
        assert!(
            text.contains("warning: no pictures") && text.contains("apt-get install mesa-vulkan-drivers"),
            "{text}"
        );
        assert_eq!(text.matches("no pictures").count(), 1, "once: {text}");
        assert_eq!(names(&place.path("out/particles"))?.len(), 2);
        assert_eq!(names(&place.path("out/mesh"))?.len(), 2);

        assert_refused(&run(&["--pictures", "surface"])?, 4, &["apt-get install mesa-vulkan-drivers"]);
        assert_refused(&run(&["--device", "gpu"])?, 4, &["driver"]);
        Ok(())
    }

    #[test]
    fn a_failure_to_write_to_stdout_is_an_error() -> Outcome {
        let place = Place::new()?;
        for arguments in [
            &["scenes"][..],
            &["scenes", "schema"],
            &["check", "small.toml"],
            &["run", "small.toml", "--json", "--no-pictures", "--device", "cpu"],
        ] {
            let mut command = Command::new(assert_cmd::cargo::cargo_bin!("splashdown"));
            command.current_dir(place.path(".")).args(arguments);
            let full = std::fs::File::options().write(true).open("/dev/full")?;
            assert_refused(&command.stdout(full).output()?, 5, &["standard output"]);
        }
        // The run itself is complete.
        assert!(place.path("out/small/particles/particles_0002.ply").exists());
        Ok(())
    }

    #[test]
    fn a_limit_of_the_size_of_files_is_reported() -> Outcome {
        let place = Place::new()?;
        // Two blocks of 512 bytes.
        let mut command = Command::new("sh");
        command
            .args(["-c", "ulimit -f 2; exec \"$0\" \"$@\""])
            .arg(assert_cmd::cargo::cargo_bin!("splashdown"));
        command.args(["run", "small.toml", "--device", "cpu", "--no-pictures", "--out", "out"]);
        command.current_dir(place.path("."));
        assert_refused(&command.output()?, 5, &["too large", "ulimit -f"]);
        Ok(())
    }

    #[test]
    fn a_full_disk_is_reported_and_complete_frames_remain() -> Outcome {
        let place = Place::new()?;
        let Some(disk) = TinyDisk::mount(place.path("disk"), 128)? else {
            eprintln!("SKIPPED: a small file system cannot be mounted");
            return Ok(());
        };
        let arguments = [
            "run",
            "small.toml",
            "--device",
            "cpu",
            "--no-pictures",
            "--no-surface",
            "--frames",
            "40",
            "--out",
            "disk/out",
        ];
        let output = place.splashdown(&arguments).output()?;
        assert_refused(&output, 5, &["disk is full", "complete"]);
        let frames = names(&disk.0.join("out/particles"))?;
        assert!(!frames.is_empty() && frames.len() < 41, "{frames:?}");
        for frame in frames {
            assert_eq!(ply::read_particles(&disk.0.join("out/particles").join(frame))?.len(), 216);
        }
        Ok(())
    }

    #[test]
    fn ctrl_c_stops_after_the_frame() -> Outcome {
        let place = Place::new()?;
        let mut command = Command::new(assert_cmd::cargo::cargo_bin!("splashdown"));
        command.current_dir(place.path(".")).args([
            "run",
            "small.toml",
            "--device",
            "cpu",
            "--no-pictures",
            "--json",
            "--frames",
            "100000",
            "--out",
            "out",
        ]);
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn()?;
        let pid = child.id().to_string();
        let mut reader = BufReader::new(child.stdout.take().ok_or("no stdout")?);
        let mut seen = String::new();
        while !seen.contains("\"frame\",\"frame\":3") {
            assert!(reader.read_line(&mut seen)? > 0, "the run ended early: {seen}");
        }
        assert!(Command::new("kill").args(["-INT", &pid]).status()?.success());
        let mut rest = String::new();
        std::io::Read::read_to_string(&mut reader, &mut rest)?;
        let output = child.wait_with_output()?;
        assert_eq!(output.status.code(), Some(130), "{} {}", stdout(&output), stderr(&output));
        assert!(rest.lines().last().is_some_and(|line| line.contains("\"interrupted\"")), "{rest}");
        let report = std::fs::read_to_string(place.path("out/run.json"))?;
        assert!(report.contains("\"interrupted\""), "{report}");
        for frame in names(&place.path("out/particles"))? {
            assert_eq!(ply::read_particles(&place.path("out/particles").join(frame))?.len(), 216);
        }
        Ok(())
    }
}
