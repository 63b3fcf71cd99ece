//! The commands that neither simulate nor draw: help, scenes, check, doctor, completions.

use crate::place::{Outcome, Place, SMALL, splashdown, stderr, stdout};
use serde_json::Value;

#[test]
fn the_help_equals_its_snapshot() -> Outcome {
    for (name, arguments) in [
        ("help", &["--help"][..]),
        ("help_run", &["run", "--help"]),
        ("help_check", &["check", "--help"]),
        ("help_scenes", &["scenes", "--help"]),
        ("help_bench", &["bench", "--help"]),
        ("help_plot", &["plot", "--help"]),
        ("help_surface", &["surface", "--help"]),
    ] {
        let output = splashdown(arguments).output()?;
        assert!(output.status.success());
        let text = stdout(&output).replace("splashdown.exe", "splashdown");
        insta::assert_snapshot!(name, text);
    }
    Ok(())
}

#[test]
fn invalid_command_lines_exit_with_two_and_a_hint() -> Outcome {
    for arguments in [
        &["rnu"][..],
        &["run"],
        &["run", "x.toml", "--formats", "abc"],
        &["run", "x.toml", "--frames", "0"],
        &["run", "x.toml", "--no-pictures", "--pictures", "surface"],
        &["bench", "--particles", "many"],
        &["scenes", "show", "no-such-scene"],
    ] {
        let output = splashdown(arguments).output()?;
        crate::place::assert_refused(&output, 2, &[]);
    }
    let negative = splashdown(&["run", "x.toml", "--frames", "-3"]).output()?;
    crate::place::assert_refused(&negative, 2, &["'-3'", "--frames"]);
    assert!(!stderr(&negative).contains("unexpected"), "{}", stderr(&negative));
    let formats = splashdown(&["run", "x.toml", "--formats", "abc"]).output()?;
    assert!(stderr(&formats).contains("ply") && stderr(&formats).contains("vtu"), "{}", stderr(&formats));
    Ok(())
}

#[test]
fn scenes_are_listed_shown_and_copied() -> Outcome {
    let place = Place::new()?;
    let list = stdout(&place.splashdown(&["scenes"]).output()?);
    for name in ["dam-break", "double-dam-break", "falling-drop", "sloshing-tank", "honey", "thesis-64k"] {
        assert!(list.lines().any(|line| line.starts_with(name)), "{name} is missing in:\n{list}");
    }
    let shown = stdout(&place.splashdown(&["scenes", "show", "honey"]).output()?);
    assert!(place.splashdown(&["scenes", "copy", "honey"]).output()?.status.success());
    assert_eq!(std::fs::read_to_string(place.path("honey.toml"))?, shown);

    let again = place.splashdown(&["scenes", "copy", "honey"]).output()?;
    crate::place::assert_refused(&again, 5, &["honey.toml", "--force"]);
    assert!(place.splashdown(&["scenes", "copy", "honey", "--force"]).output()?.status.success());
    let nowhere = place.splashdown(&["scenes", "copy", "honey", "missing/folder/x.toml"]).output()?;
    crate::place::assert_refused(&nowhere, 5, &["missing"]);
    Ok(())
}

#[test]
fn check_prints_derived_quantities() -> Outcome {
    let place = Place::new()?;
    let words = place.splashdown(&["check", "small.toml", "--device", "cpu"]).output()?;
    assert!(words.status.success(), "{}", stderr(&words));
    for word in ["valid", "216", "particle mass", "time step", "memory", "expected time", "from a trial of"] {
        assert!(stdout(&words).contains(word), "{word} is missing in:\n{}", stdout(&words));
    }
    let json = place.splashdown(&["check", "small.toml", "--device", "cpu", "--json"]).output()?;
    let report: Value = serde_json::from_slice(&json.stdout)?;
    assert_eq!(report["particles"], 216);
    assert_eq!(report["frames"], 2);
    for key in
        ["particle_mass", "support_radius", "sound_speed", "dt_estimate", "steps_estimate", "memory_forecast"]
    {
        assert!(report[key].as_f64().is_some_and(|number| number > 0.0), "{key} in {report}");
    }
    assert!(report["speed"]["expected_seconds"].as_f64().is_some_and(|seconds| seconds > 0.0));
    assert_eq!(report["resolution"]["depth"].as_f64().map(f64::round), Some(6.0), "{report}");
    assert!(stdout(&words).contains("validated: standing wave without bodies, depth 20 spacings (here 6)"));
    Ok(())
}

/// A block that collapses in a tank, with these lines of the fluid and the solver.
fn collapsing(fluid: &str, solver: &str) -> String {
    format!(
        "[scene]\nname = \"collapse\"\nduration = 0.3\n[domain]\nmin = [0, 0, 0]\nmax = [1, 0.6, 0.5]\nopen = [\"y_max\"]\n\
         [fluid]\nparticle_spacing = 0.022\n{fluid}[[fluid.block]]\nposition = [0, 0, 0]\nsize = [0.5, 0.4, 0.5]\n[solver]\n{solver}\n\
         [surface]\nenabled = false\n"
    )
}

#[test]
fn check_predicts_the_steps_of_a_run() -> Outcome {
    let place = Place::new()?;
    let scenes = [
        ("water", "", "method = \"dfsph\""),
        ("honey", "viscosity = 0.1\n", "method = \"dfsph\""),
        ("explicit", "", "method = \"wcsph\""),
    ];
    let mut estimates = Vec::new();
    for (name, fluid, solver) in scenes {
        let file = format!("{name}.toml");
        place.write(&file, collapsing(fluid, solver))?;
        let check = place.splashdown(&["check", &file, "--device", "cpu", "--json"]).output()?;
        let report: Value = serde_json::from_slice(&check.stdout)?;
        // The trial has fewer particles than the scene.
        let fewer = report["speed"]["trial"]["particles"].as_f64().zip(report["particles"].as_f64());
        assert!(fewer.is_some_and(|(trial, whole)| trial < 0.8 * whole), "{report}");
        let run = place.splashdown(&["run", &file, "--device", "cpu", "--json", "--no-pictures"]).output()?;
        let summary: Value = serde_json::from_str(stdout(&run).lines().last().ok_or("no output")?)?;
        let steps = summary["steps"].as_f64().ok_or("no steps")?;
        let ratio = |value: &Value| value.as_f64().unwrap_or_default() / steps;
        let predicted = ratio(&report["speed"]["expected_steps"]);
        assert!((0.75..1.25).contains(&predicted), "{name}: {predicted} of {steps} steps");
        estimates.push(ratio(&report["steps_estimate"]));
    }
    // Control: the estimate from the expected speed is wrong for the viscous liquid.
    assert!(estimates[1] > 1.25, "{estimates:?}");
    Ok(())
}

#[test]
fn check_counts_emitted_and_removed_particles() -> Outcome {
    let place = Place::new()?;
    let tap = "[[emitter]]\nname = \"tap\"\nshape = \"rectangle\"\nsize = [0.1, 0.1]\nposition = [0.5, 0.8, 0.15]\n\
               direction = [0, -1, 0]\nspeed = 50\n";
    let block = "[[fluid.block]]\nposition = [0, 0, 0]\nsize = [0.3, 0.3, 0.3]\n";
    place.write("tap.toml", SMALL.replace(block, tap))?;
    let json = place.splashdown(&["check", "tap.toml", "--device", "cpu", "--json"]).output()?;
    let report: Value = serde_json::from_slice(&json.stdout)?;
    // Ten layers of four, and one more.
    assert_eq!((&report["particles"], &report["emitted"]), (&Value::from(0), &Value::from(44)), "{report}");
    assert!(report["speed"]["expected_seconds"].as_f64().is_some_and(|seconds| seconds > 0.0), "{report}");
    let post = "[[body]]\nname = \"post\"\nmesh = \"block\"\nposition = [0.15, 0.1, 0.15]\n";
    place.write("post.toml", SMALL.replace("[output]", &format!("{post}[output]")))?;
    let json = place.splashdown(&["check", "post.toml", "--device", "cpu", "--json"]).output()?;
    let report: Value = serde_json::from_slice(&json.stdout)?;
    let (left, removed) = (report["particles"].as_u64(), report["removed"].as_u64());
    assert!(removed.is_some_and(|removed| removed >= 64), "{report}");
    assert_eq!(left.zip(removed).map(|(left, removed)| left + removed), Some(216), "{report}");
    let words = place.splashdown(&["check", "post.toml", "--device", "cpu"]).output()?;
    assert!(stdout(&words).contains("in narrow gaps are removed, "), "{}", stdout(&words));
    Ok(())
}

#[test]
fn check_reports_every_problem_at_once() -> Outcome {
    let place = Place::new()?;
    let broken = SMALL
        .replace("0.05", "-1")
        .replace("frame_rate = 200", "frame_rat = 200")
        .replace("[1, 1, 0.3]", "[1, 1]");
    place.write("broken.toml", broken)?;
    let words = place.splashdown(&["check", "broken.toml"]).output()?;
    crate::place::assert_refused(
        &words,
        3,
        &["broken.toml:4", "frame_rate", "fluid.particle_spacing", "-1", "domain.max"],
    );
    let json = place.splashdown(&["check", "broken.toml", "--json"]).output()?;
    assert_eq!(json.status.code(), Some(3));
    let line: Value = serde_json::from_slice(&json.stdout)?;
    assert_eq!((&line["event"], &line["exit_code"]), (&Value::from("error"), &Value::from(3)));
    let problems = line["problems"].as_array().ok_or("no problems")?;
    assert!(problems.len() >= 3 && problems.iter().all(|problem| problem["message"].is_string()));
    Ok(())
}

#[test]
fn doctor_lists_devices_and_programs() -> Outcome {
    let words = splashdown(&["doctor"]).output()?;
    assert!(words.status.success());
    for word in ["CPU", "threads", "to simulate", "to draw", "films"] {
        assert!(stdout(&words).contains(word), "{word} is missing in:\n{}", stdout(&words));
    }
    let bare = splashdown(&["doctor", "--json"]).env_remove("XDG_RUNTIME_DIR").output()?;
    assert!(bare.stderr.is_empty(), "a driver printed: {}", stderr(&bare));
    let json: Value = serde_json::from_slice(&bare.stdout)?;
    assert!(json["cpu"]["threads"].as_u64().is_some_and(|threads| threads > 0));
    for adapter in json["adapters"].as_array().ok_or("no list")? {
        assert!(
            adapter["largest_particle_count"].as_u64().is_some_and(|count| count > 1_000_000),
            "{adapter}"
        );
    }
    Ok(())
}

#[cfg(target_os = "linux")]
#[test]
fn doctor_lists_what_is_missing_and_how_to_install_it() -> Outcome {
    let mut doctor = splashdown(&["doctor"]);
    let output = doctor
        .env("VK_DRIVER_FILES", "/nonexistent")
        .env("VK_ICD_FILENAMES", "/nonexistent")
        .env("PATH", "")
        .output()?;
    assert!(output.status.success());
    for word in
        ["No graphics adapter", "apt-get install mesa-vulkan-drivers", "no ffmpeg", "apt-get install ffmpeg"]
    {
        assert!(stdout(&output).contains(word), "{word} is missing in:\n{}", stdout(&output));
    }
    Ok(())
}

#[test]
fn completions_contain_every_command() -> Outcome {
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let output = splashdown(&["completions", shell]).output()?;
        assert!(output.status.success());
        for word in ["run", "check", "doctor", "scenes", "bench", "completions", "no-surface"] {
            assert!(stdout(&output).contains(word), "{word} is missing for {shell}");
        }
    }
    Ok(())
}

#[test]
fn schema_is_json_and_the_reference_lists_keys() -> Outcome {
    let schema: Value = serde_json::from_slice(&splashdown(&["scenes", "schema"]).output()?.stdout)?;
    assert!(schema["properties"]["fluid"].is_object());
    let reference = stdout(&splashdown(&["scenes", "reference"]).output()?);
    assert!(reference.contains("| `particle_spacing` |") && reference.contains("## `[[fluid.block]]`"));
    Ok(())
}
