//! Renders the pictures of the README and of the window's gallery, and the film of the web page.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail, ensure};

use crate::process::{self, say};
use crate::{setup, window_picture};

/// One picture of the README.
struct Shown {
    kind: &'static str,
    frame: u32,
    /// Name in `docs/pictures`, without the extension.
    name: &'static str,
}

const fn shown(kind: &'static str, frame: u32, name: &'static str) -> Shown {
    Shown { kind, frame, name }
}

/// Scenes and the frames that are shown of them.
const PICTURES: [(&str, &[Shown]); 11] = [
    ("dam-break", &[shown("surface", 101, "dam-break"), shown("particles", 91, "dam-break-particles")]),
    ("falling-drop", &[shown("surface", 30, "falling-drop")]),
    ("honey", &[shown("surface", 20, "honey")]),
    ("lighthouse", &[shown("surface", 20, "lighthouse")]),
    ("knot", &[shown("surface", 22, "knot")]),
    ("floating", &[shown("surface", 14, "floating")]),
    ("boat", &[shown("surface", 22, "boat")]),
    ("paddle-wheel", &[shown("surface", 30, "paddle-wheel")]),
    ("spheric2", &[shown("surface", 34, "spheric2")]),
    ("cup", &[shown("surface", 86, "cup")]),
    ("sloshing-tank", &[shown("surface", 60, "sloshing-tank")]),
];

/// Scenes that appear only in the window's gallery, with the frame of the surface that is shown.
const THUMBNAILS: [(&str, u32); 9] = [
    ("dam-break-small", 18),
    ("double-dam-break", 16),
    ("drum", 36),
    ("honey-coil", 20),
    ("thesis-8k", 16),
    ("thesis-16k", 16),
    ("thesis-32k", 16),
    ("thesis-64k", 16),
    ("thin-cup", 30),
];

/// The scene and the frame that the guide shows with `wcsph` beside the picture with `dfsph`.
const WITH_BOTH_SOLVERS: (&str, u32) = ("dam-break", 101);

/// The name of the picture of the window among the arguments.
const WINDOW: &str = "window";

/// The film of the web page for browsers without WebGPU: scene and last frame. With frame 0 it has 52 pictures.
const FILM: (&str, u32) = ("dam-break-small", 51);
/// Its pictures per second.
const FILM_RATE: u32 = 12;

/// The command `pictures`. Arguments are names of scenes, or `window`; without any, all pictures are rendered.
pub fn run(arguments: &[String]) -> Result<()> {
    let wanted = |scene: &str| arguments.is_empty() || arguments.iter().any(|argument| argument == scene);
    let shown = PICTURES.iter().map(|(scene, _)| *scene);
    let names: Vec<_> = shown.chain(THUMBNAILS.iter().map(|(scene, _)| *scene)).chain([WINDOW]).collect();
    if let Some(unknown) = arguments.iter().find(|argument| !names.contains(&argument.as_str())) {
        bail!("there is no picture {unknown:?}; allowed: {}", names.join(", "));
    }
    setup::ensure_requirements()?;
    let binary = process::build_release()?;
    for (scene, pictures) in PICTURES.iter().filter(|(scene, _)| wanted(scene)) {
        let out = format!("out/pictures/{scene}");
        let last = pictures.iter().map(|shown| shown.frame).max().unwrap_or(0).to_string();
        let mut command = process::command(&binary);
        command.args(["run", scene, "--out", &out, "--frames", &last, "--formats", "ply", "--no-film"]);
        let has_particles = pictures.iter().any(|shown| shown.kind == "particles");
        process::run(if has_particles {
            command.args(["--pictures", "particles"])
        } else {
            command.arg("--no-pictures")
        })?;
        for Shown { kind, frame, name } in *pictures {
            let from = if *kind == "surface" {
                still(&binary, &out, *frame)?
            } else {
                process::root().join(&out).join(format!("pictures/{kind}_{frame:04}.png"))
            };
            let to = process::root().join(format!("docs/pictures/{name}.png"));
            fs::create_dir_all(to.with_file_name(""))?;
            fs::copy(&from, &to).with_context(|| format!("cannot copy {}", from.display()))?;
            say(format!("docs/pictures/{name}.png"));
            if name == scene {
                thumbnail(&to, name)?;
            }
        }
    }
    if wanted(WITH_BOTH_SOLVERS.0) {
        with_wcsph(&binary)?;
    }
    for (scene, frame) in THUMBNAILS.iter().filter(|(scene, _)| wanted(scene)) {
        let out = format!("out/pictures/{scene}");
        let last = if *scene == FILM.0 { FILM.1 } else { *frame };
        let mut command = process::command(&binary);
        command.args(["run", scene, "--out", &out, "--frames", &last.to_string(), "--formats", "ply"]);
        process::run(command.args(["--no-film", "--no-pictures"]))?;
        thumbnail(&still(&binary, &out, *frame)?, scene)?;
        if *scene == FILM.0 {
            film(&binary, &out)?;
        }
    }
    if wanted(WINDOW) {
        window_picture::draw(&binary)?;
    }
    Ok(())
}

/// Draws a scene of `dfsph` with `wcsph`.
fn with_wcsph(binary: &Path) -> Result<()> {
    let (scene, frame) = WITH_BOTH_SOLVERS;
    let from = process::root().join(format!("scenes/{scene}.toml"));
    let text = fs::read_to_string(&from).with_context(|| format!("cannot read {}", from.display()))?;
    let changed = text.replace("method = \"dfsph\"", "method = \"wcsph\"");
    ensure!(changed != text, "{} does not use dfsph", from.display());
    let out = format!("out/pictures/{scene}-wcsph");
    let file = process::root().join(format!("{out}.toml"));
    fs::create_dir_all(file.with_file_name(""))?;
    fs::write(&file, changed).with_context(|| format!("cannot write {}", file.display()))?;
    let mut command = process::command(binary);
    command.arg("run").arg(&file).args(["--out", &out, "--frames", &frame.to_string(), "--formats", "ply"]);
    process::run(command.args(["--no-film", "--no-pictures"]))?;
    let to = format!("docs/pictures/{scene}-wcsph.png");
    fs::copy(still(binary, &out, frame)?, process::root().join(&to))
        .with_context(|| format!("cannot write {to}"))?;
    say(to);
    Ok(())
}

/// Draws one frame of a finished run with traced rays; returns the picture.
fn still(binary: &Path, out: &str, frame: u32) -> Result<PathBuf> {
    let folder = process::root().join(out).join("still");
    if folder.exists() {
        fs::remove_dir_all(&folder).with_context(|| format!("cannot empty {}", folder.display()))?;
    }
    let mut command = process::command(binary);
    command.args(["render", out, "--frames", &frame.to_string(), "--out"]).arg(&folder);
    process::run(&mut command)?;
    Ok(folder.join("picture_0000.png"))
}

/// Draws all frames of a finished run and writes the film of the web page.
fn film(binary: &Path, out: &str) -> Result<()> {
    let folder = process::root().join(out).join("film");
    let mut command = process::command(binary);
    process::run(command.args(["render", out, "--size", "384x216", "--out"]).arg(&folder))?;
    let mut ffmpeg = process::command("ffmpeg");
    ffmpeg
        .args(["-y", "-loglevel", "error", "-framerate", &FILM_RATE.to_string(), "-i"])
        .arg(folder.join("picture_%04d.png"));
    process::run(ffmpeg.args(["-c:v", "libwebp_anim", "-quality", "55", "-loop", "0", "web/film.webp"]))
}

/// A small picture for the gallery of the window. It has few colours, because all thumbnails are embedded in the program.
fn thumbnail(from: &Path, name: &str) -> Result<()> {
    let to = format!("crates/splashdown-viewer/thumbnails/{name}.png");
    let filter = "scale=192:108:flags=lanczos,split[a][b];[a]palettegen=max_colors=96[p];[b][p]paletteuse";
    let mut ffmpeg = process::command("ffmpeg");
    ffmpeg.args(["-y", "-loglevel", "error", "-i"]).arg(from);
    process::run(ffmpeg.args(["-filter_complex", filter, &to]))
}

#[cfg(test)]
mod tests {
    use super::{FILM, FILM_RATE};

    #[test]
    fn the_film_of_the_page_lasts_more_than_four_seconds() {
        // A part of a second is left for programs that drop the duration of the last picture.
        let seconds = f64::from(FILM.1 + 1) / f64::from(FILM_RATE);
        assert!(seconds >= 4.2, "{seconds} s");
    }
}
