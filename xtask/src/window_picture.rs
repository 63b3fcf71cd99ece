//! Draws the picture of the window in the README and the guide, on a virtual X server.

use std::fs;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

use anyhow::{Context, Result, ensure};

use crate::process::{self, command, say};
use crate::setup;

const SCENE: &str = "lighthouse";
/// The frame that the window starts from: the wave meets the lighthouse.
const FRAME: &str = "13";
/// The size of the window in pixels.
const SIZE: &str = "1280x800";
/// The view of the surface, and the settings.
const KEYS: [&str; 2] = ["3", "c"];

/// How long the picture may take. A paused window draws in parts until the picture is sharp.
const LONGEST: Duration = Duration::from_secs(180);
/// A picture that stays the same for this long is complete.
const UNCHANGED: Duration = Duration::from_secs(10);

/// Kills the process when dropped.
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Simulates up to the frame, opens its checkpoint in a window, pauses and takes the picture.
pub fn draw(binary: &Path) -> Result<()> {
    setup::ensure_screen();
    let out = process::root().join("out/pictures/window");
    let mut run = command(binary);
    run.args(["run", SCENE, "--frames", FRAME, "--checkpoint-every", FRAME, "--out"]).arg(&out);
    process::run(run.args(["--formats", "none", "--no-surface", "--no-pictures"]))?;

    let mut server = command("Xvfb");
    server.args(["-displayfd", "1", "-screen", "0", &format!("{SIZE}x24")]);
    server.stdout(Stdio::piped()).stderr(Stdio::null());
    let mut server = Running(server.spawn().context("cannot start Xvfb")?);
    let mut number = String::new();
    let output = server.0.stdout.take().context("Xvfb has no output")?;
    BufReader::new(output).read_line(&mut number)?;
    let display = format!(":{}", number.trim());

    let mut view = command(binary);
    view.arg("view").arg(out.join("checkpoints")).args(["--size", SIZE]).env("DISPLAY", &display);
    // The list of recent files stays as it is.
    let _window = Running(view.env("XDG_STATE_HOME", &out).spawn().context("cannot start the window")?);
    // The keys of one call reach the window before it draws again.
    let mut keys = command("xdotool");
    keys.env("DISPLAY", &display);
    keys.args(["search", "--sync", "--onlyvisible", "--name", "Splashdown", "windowfocus", "--sync"]);
    process::run(keys.args(["key", "space"]).arg("key").args(KEYS))?;

    let picture = settled(&display)?;
    let to = process::root().join("docs/pictures/window.png");
    fs::write(&to, picture).with_context(|| format!("cannot write {}", to.display()))?;
    say("docs/pictures/window.png");
    Ok(())
}

/// The picture of the screen as PNG, once it no longer changes.
fn settled(display: &str) -> Result<Vec<u8>> {
    let begun = Instant::now();
    let (mut last, mut since) = (Vec::new(), begun);
    loop {
        std::thread::sleep(Duration::from_secs(1));
        let mut import = command("import");
        // Without dates, equal pictures are equal files.
        import.env("DISPLAY", display).args(["-window", "root", "+set", "date:create"]);
        import.args(["+set", "date:modify", "-define", "png:exclude-chunks=date,time", "png:-"]);
        let output = import.output().context("cannot start import")?;
        ensure!(output.status.success(), "import failed: {}", String::from_utf8_lossy(&output.stderr));
        if output.stdout != last {
            (last, since) = (output.stdout, Instant::now());
        } else if since.elapsed() >= UNCHANGED {
            return Ok(last);
        }
        ensure!(begun.elapsed() < LONGEST, "the picture of the window still changes after {LONGEST:?}");
    }
}
