//! Builds the web page into `target/page` and serves it on localhost.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, bail, ensure};

use crate::process::{self, cargo, command, say};
use crate::serve;

/// Allowed size of the compressed page in bytes.
const BUDGET: u64 = 5_000_000;
/// The build profile of the published page.
pub const PUBLISHED: &str = "web";
/// The build profile of the page in tests.
pub const QUICK: &str = "dev";
const TARGET: &str = "wasm32-unknown-unknown";

/// The command `web`: `--build` only builds, `--port N` selects the port.
pub fn run(arguments: &[String]) -> Result<()> {
    let mut port = 8080;
    let mut only_build = false;
    let mut arguments = arguments.iter();
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--build" => only_build = true,
            "--port" => {
                let value = arguments.next().context("--port needs a number")?;
                port = value
                    .parse()
                    .with_context(|| format!("--port {value:?} is not a number from 0 to 65535"))?;
            }
            other => bail!("web takes --build or --port N, got {other}"),
        }
    }
    let folder = build(PUBLISHED)?;
    if only_build {
        return Ok(());
    }
    let server = serve::Server::new(&folder, port)?;
    say(format!("Serving Splashdown at {}; press Ctrl-C to stop", server.address()));
    server.serve()
}

/// Builds the page with a profile and returns its folder. Only the published page is checked against the size limit.
pub fn build(profile: &str) -> Result<PathBuf> {
    let added = command("rustup").args(["target", "add", TARGET]).output().context("cannot start rustup")?;
    ensure!(
        added.status.success(),
        "`rustup target add {TARGET}` failed: {}",
        String::from_utf8_lossy(&added.stderr).trim()
    );
    say("Building the page ...");
    process::run(&mut cargo([
        "build",
        "--package",
        "splashdown-web",
        "--target",
        TARGET,
        "--profile",
        profile,
    ]))?;
    let target = process::target();
    let folder = target.join("page");
    fs::create_dir_all(&folder).with_context(|| format!("cannot create {}", folder.display()))?;
    // The output folder of the profile `dev` is called `debug`.
    let name = if profile == "dev" { "debug" } else { profile };
    let module = target.join(TARGET).join(name).join("splashdown_web.wasm");
    let mut bindgen = cargo(["run", "--quiet", "--package", "splashdown-bindgen", "--"]);
    process::run(bindgen.arg(&module).arg(&folder))?;
    write_page(&folder)?;
    if profile == PUBLISHED {
        check_size(&folder)?;
    }
    Ok(folder)
}

/// Copies the page and its film. The page contains the size of the program, which a server that compresses does not tell.
fn write_page(folder: &Path) -> Result<()> {
    const SIZE: &str = "@PROGRAM_BYTES@";
    let page = fs::read_to_string(process::root().join("web/index.html"))?;
    ensure!(page.contains(SIZE), "web/index.html does not contain {SIZE}");
    let bytes = fs::metadata(folder.join("splashdown_web_bg.wasm"))?.len();
    fs::write(folder.join("index.html"), page.replace(SIZE, &bytes.to_string()))?;
    fs::copy(process::root().join("web/film.webp"), folder.join("film.webp"))?;
    Ok(())
}

/// Compresses the files as a server would and checks their total size against the limit.
fn check_size(folder: &Path) -> Result<()> {
    let mut sum = 0;
    // The film is loaded only where the program cannot run.
    for name in ["splashdown_web_bg.wasm", "splashdown_web.js", "index.html"] {
        let file = folder.join(name);
        let packed = Command::new("gzip").args(["-9", "--stdout"]).arg(&file).output();
        let bytes = match packed {
            Ok(output) if output.status.success() => output.stdout.len() as u64,
            // Without gzip the uncompressed size counts.
            _ => fs::metadata(&file)?.len(),
        };
        say(format!("  {name}: {:.2} MB compressed", bytes as f64 / 1e6));
        sum += bytes;
    }
    ensure!(sum <= BUDGET, "the compressed page has {sum} bytes, more than the allowed {BUDGET}");
    Ok(())
}
