//! The messages of a program that was built without Cargo features. Each test exists only in a build without its
//! feature; `cargo xtask test --all` makes that build.

#![cfg(not(all(feature = "plot", feature = "rigid", feature = "window")))]

use std::process::Output;

use assert_cmd::Command;

type Outcome = Result<(), Box<dyn std::error::Error>>;

fn splashdown(arguments: &[&str]) -> std::io::Result<Output> {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin!("splashdown"));
    command.args(arguments).timeout(std::time::Duration::from_secs(120)).output()
}

fn assert_refused(output: &Output, code: i32, words: &[&str]) {
    let text = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "{text}");
    assert!(text.starts_with("error: "), "{text}");
    for word in words {
        assert!(text.contains(word), "`{word}` is missing in:\n{text}");
    }
}

#[cfg(not(feature = "window"))]
#[test]
fn the_command_view_names_its_feature() -> Outcome {
    let output = splashdown(&["view", "dam-break-small"])?;
    assert_refused(&output, 2, &["without `splashdown view`", "feature `window`", "cargo install --path"]);
    Ok(())
}

#[cfg(not(feature = "plot"))]
#[test]
fn the_command_plot_names_its_feature() -> Outcome {
    let output = splashdown(&["plot", "table.csv", "--out", "plot.svg"])?;
    assert_refused(&output, 2, &["without `splashdown plot`", "feature `plot`", "cargo install --path"]);
    Ok(())
}

#[cfg(not(feature = "rigid"))]
#[test]
fn a_dynamic_body_names_its_feature() -> Outcome {
    const SCENE: &str = "
[scene]
name = \"ball\"
duration = 0.02
[domain]
min = [0, 0, 0]
max = [1, 1, 1]
[fluid]
particle_spacing = 0.05
[[fluid.block]]
position = [0, 0, 0]
size = [1, 0.3, 1]
[[body]]
name = \"buoy\"
mesh = \"sphere\"
position = [0.5, 0.7, 0.5]
";
    let folder = tempfile::tempdir()?;
    let (scene, out) = (folder.path().join("ball.toml"), folder.path().join("out"));
    let scene_name = scene.display().to_string();
    let arguments =
        ["run", &scene_name, "--out", &out.display().to_string(), "--device", "cpu", "--no-pictures"];
    std::fs::write(&scene, format!("{SCENE}motion = \"dynamic\"\ndensity = 500\n"))?;
    let words = ["\"buoy\"", "dynamic", "feature `rigid`", "static or scripted"];
    assert_refused(&splashdown(&arguments)?, 3, &words);
    assert_refused(&splashdown(&["check", &scene_name, "--device", "cpu"])?, 3, &words);
    // Control: a static body needs no feature.
    std::fs::write(&scene, SCENE)?;
    let output = splashdown(&arguments)?;
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    Ok(())
}
