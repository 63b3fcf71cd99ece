//! `cargo xtask cycles`: draws frames of built-in scenes with Splashdown and with Cycles, the path tracer of Blender,
//! and writes the pairs and their differences into the guide.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail, ensure};
use serde_json::Value;

use crate::process::{self, root, say, target};
use crate::python;

/// A scene with changes of its file, and the frames that are drawn.
struct Case {
    scene: &'static str,
    /// Text of the file and what replaces it: fewer particles, nothing that Cycles has no counterpart of, and a closer camera.
    changes: &'static [(&'static str, &'static str)],
    frames: &'static [u32],
}

const CASES: [Case; 4] = [
    Case {
        scene: "dam-break",
        changes: &[
            ("particle_spacing = 0.015625", "particle_spacing = 0.03125"),
            ("frame_rate = 80", "frame_rate = 40"),
            ("enabled = true", "enabled = false"),
            ("target = [1.1, 0.6, 0.4]", "target = [0.9, 0.35, 0.4]"),
            ("distance = 3.4", "distance = 2.2"),
        ],
        frames: &[16, 32, 44],
    },
    Case {
        scene: "falling-drop",
        changes: &[("particle_spacing = 0.002 ", "particle_spacing = 0.0025 ")],
        frames: &[8, 16, 26],
    },
    Case {
        scene: "floating",
        changes: &[
            ("particle_spacing = 0.02", "particle_spacing = 0.04"),
            ("enabled = true", "enabled = false"),
        ],
        frames: &[9, 15],
    },
    Case {
        scene: "lighthouse",
        changes: &[
            ("particle_spacing = 0.02", "particle_spacing = 0.04"),
            ("liquid = \"sea\"", "liquid = \"water\""),
            ("enabled = true", "enabled = false"),
        ],
        frames: &[12, 20],
    },
];

const SIZE: [u32; 2] = [320, 180];
/// Where the guide finds the pairs.
const PAIRS: &str = "docs/pictures/cycles";
const TABLE: &str = "docs/cycles.md";

/// The options.
#[derive(Debug, PartialEq)]
struct Options {
    /// Samples per pixel of Cycles.
    samples: u32,
    /// Simulate and draw everything again.
    again: bool,
    /// Build without optimization of the dependencies, which is quicker than a first release build.
    dev: bool,
}

impl Options {
    fn parse(arguments: &[String]) -> Result<Self> {
        let mut options = Self { samples: 64, again: false, dev: false };
        let mut words = arguments.iter();
        while let Some(word) = words.next() {
            match word.as_str() {
                "--again" => options.again = true,
                "--dev" => options.dev = true,
                "--samples" => {
                    let number = words.next().and_then(|text| text.parse().ok()).filter(|&n| n > 0);
                    options.samples = number.context("--samples takes a number above 0")?;
                }
                other => {
                    bail!("cycles takes --samples N, --again and --dev, got {other}; `cargo xtask help`")
                }
            }
        }
        Ok(options)
    }
}

/// Draws the pairs, and writes them and the table of their differences.
///
/// # Errors
/// If a program cannot be built or installed, or fails.
pub fn run(arguments: &[String]) -> Result<()> {
    let options = Options::parse(arguments)?;
    let folder = target().join("cycles");
    fs::create_dir_all(&folder)?;
    let list = root().join("xtask/cycles/requirements.txt");
    let python = python::environment(None, &folder.join("python"), &list)
        .context("cannot install Blender as a Python package, which exists for Python 3.11 only")?;
    let profile = if options.dev { "dev" } else { "release" };
    let build = |what: &[&str]| process::run(process::cargo(["build", "--profile", profile]).args(what));
    build(&["--package", "splashdown-cli"])?;
    build(&["--package", "splashdown-run", "--example", "picture_data"])?;
    let built = target().join(if options.dev { "debug" } else { "release" });
    let program = |name: &str| built.join(format!("{name}{}", std::env::consts::EXE_SUFFIX));
    let (splashdown, data) = (program("splashdown"), program("examples/picture_data"));

    let mut names = Vec::new();
    for case in &CASES {
        let scene = folder.join(format!("{}.toml", case.scene));
        let is_new = write_scene(case, &scene)?;
        let run = folder.join(case.scene);
        let light_of = |frame: u32| folder.join(format!("{}-{frame}.npy", case.scene));
        let last = case.frames.iter().max().context("a case without frames")?;
        if is_new || options.again {
            // After an interruption nothing of an earlier scene may be left.
            remove(&run)?;
            case.frames.iter().try_for_each(|frame| remove(&light_of(*frame)))?;
        }
        if !run.join(format!("mesh/surface_{last:04}.ply")).exists() {
            let mut simulate = process::command(&splashdown);
            simulate.arg("run").arg(&scene).arg("--out").arg(&run).args(["--frames", &last.to_string()]);
            process::run(simulate.args(["--formats", "ply", "--no-pictures", "--no-film"]))?;
        }
        for frame in case.frames {
            let name = format!("{}-{frame}", case.scene);
            draw(&splashdown, &scene, &run, *frame, &folder.join(format!("{name}.png")))?;
            let light = light_of(*frame);
            if !light.exists() {
                say(format!("Cycles: {name} ..."));
                let description = folder.join(format!("{name}.json"));
                let mut describe = process::command(&data);
                process::run(describe.arg(&scene).arg(&run).arg(frame.to_string()).arg(&description))?;
                let mut cycles = process::command(&python);
                cycles.arg("xtask/cycles/render.py").arg(&description);
                cycles.args([SIZE[0], SIZE[1], options.samples].map(|number| number.to_string()));
                process::run(cycles.arg(&light))?;
            }
            names.push(name);
        }
    }
    write_table(&compare(&python, &folder, &names)?)
}

/// Removes a file or folder, if it exists.
fn remove(path: &Path) -> Result<()> {
    let removed = if path.is_dir() { fs::remove_dir_all(path) } else { fs::remove_file(path) };
    match removed {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
            Err(error).with_context(|| format!("cannot remove {}", path.display()))
        }
        _ => Ok(()),
    }
}

/// Writes the changed scene; whether it differs from that of an earlier call.
fn write_scene(case: &Case, path: &Path) -> Result<bool> {
    let mut text = fs::read_to_string(root().join(format!("scenes/{}.toml", case.scene)))?;
    for (from, to) in case.changes {
        ensure!(text.contains(from), "scenes/{}.toml does not contain `{from}` any more", case.scene);
        text = text.replace(from, to);
    }
    // The caption would be the largest difference.
    text = match text.contains("[picture]") {
        true => text.replace("[picture]", "[picture]\ncaption = \"\""),
        false => text + "\n[picture]\ncaption = \"\"\n",
    };
    if fs::read_to_string(path).is_ok_and(|old| old == text) {
        return Ok(false);
    }
    fs::write(path, text)?;
    Ok(true)
}

/// Draws a frame with `--quality standard`, the default.
fn draw(splashdown: &Path, scene: &Path, run: &Path, frame: u32, to: &Path) -> Result<()> {
    let out: PathBuf = to.with_extension("render");
    if out.exists() {
        fs::remove_dir_all(&out)?;
    }
    let mut render = process::command(splashdown);
    render.arg("render").arg(run).arg("--scene").arg(scene).arg("--out").arg(&out);
    render.args(["--quality", "standard", "--frames", &frame.to_string()]);
    process::run(render.args(["--size", &format!("{}x{}", SIZE[0], SIZE[1])]))?;
    fs::copy(out.join("picture_0000.png"), to).with_context(|| format!("cannot write {}", to.display()))?;
    Ok(())
}

/// Writes the pairs; returns the differences.
fn compare(python: &Path, folder: &Path, names: &[String]) -> Result<Vec<Value>> {
    let mut compare = process::command(python);
    compare.arg("xtask/cycles/compare.py").arg(folder).arg(root().join(PAIRS)).args(names);
    let output = compare.output().context("cannot start the comparison")?;
    let errors = String::from_utf8_lossy(&output.stderr);
    ensure!(output.status.success(), "the comparison failed:\n{errors}");
    let text = String::from_utf8_lossy(&output.stdout);
    let line =
        text.lines().rev().find(|line| line.starts_with('[')).context("the comparison printed nothing")?;
    Ok(serde_json::from_str(line)?)
}

fn write_table(rows: &[Value]) -> Result<()> {
    let mut text = String::from(
        "| frame | brightness | Cycles | contrast | Cycles | SSIM | FLIP |\n|---|---:|---:|---:|---:|---:|---:|\n",
    );
    let mut sums = [0.0; 6];
    for row in rows {
        let name = row["name"].as_str().context("a row without a name")?;
        let of = |value: &Value| value.as_f64().context("a row without a number");
        let (brightness, contrast) = (&row["brightness"], &row["contrast"]);
        let numbers = [
            of(&brightness[0])?,
            of(&brightness[1])?,
            of(&contrast[0])?,
            of(&contrast[1])?,
            of(&row["ssim"])?,
            of(&row["flip"])?,
        ];
        sums.iter_mut().zip(numbers).for_each(|(sum, number)| *sum += number);
        add_row(&mut text, name, numbers)?;
    }
    add_row(&mut text, "mean", sums.map(|sum| sum / rows.len() as f64))?;
    fs::write(root().join(TABLE), &text).with_context(|| format!("cannot write {TABLE}"))?;
    say(format!("{text}\nWritten: {TABLE} and {PAIRS}"));
    Ok(())
}

fn add_row(text: &mut String, name: &str, numbers: [f64; 6]) -> Result<()> {
    let cells: Vec<_> = numbers.iter().map(|number| format!("{number:.3}")).collect();
    Ok(writeln!(text, "| {name} | {} |", cells.join(" | "))?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_scenes_contain_what_the_cases_change() {
        let folder = std::env::temp_dir().join(format!("splashdown-cycles-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        for case in &CASES {
            let path = folder.join(case.scene);
            assert!(write_scene(case, &path).unwrap(), "the file is new");
            assert!(!write_scene(case, &path).unwrap(), "the file is the same");
            let text = fs::read_to_string(&path).unwrap();
            assert_eq!(text.matches("caption = \"\"").count(), 1);
        }
        let wrong = Case { scene: "floating", changes: &[("no such text", "")], frames: &[1] };
        assert!(write_scene(&wrong, &folder.join("wrong")).is_err());
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn unknown_options_are_rejected() {
        let parse = |words: &[&str]| Options::parse(&words.iter().map(|&w| w.to_owned()).collect::<Vec<_>>());
        assert_eq!(parse(&["--samples", "8"]).unwrap(), Options { samples: 8, again: false, dev: false });
        for wrong in [&["--samples", "0"][..], &["--samples"], &["--fast"]] {
            assert!(parse(wrong).is_err(), "{wrong:?}");
        }
    }
}
