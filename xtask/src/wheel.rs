//! `cargo xtask wheel`: builds the Python package and tests it as a user installs it.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::{Context, Result, bail, ensure};

use crate::layers::{self, Outcome, succeeds};
use crate::process::{self, cargo, command, root, say, target};
use crate::test_output::Filter;
use crate::{python, report, setup};

/// Particles for the comparison beside the repository, and their spacing in m.
const SHARED: (&str, &str) = ("../shared/data/particles/mid64k.npy", "0.05");

/// How the wheel is built.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Build {
    /// As it is published.
    Release,
    /// For tests: without the window and plots, and with the dependencies of the other tests, which are built already.
    Quick,
}

/// A built wheel.
struct Wheel {
    path: PathBuf,
    seconds: f64,
}

/// The command `wheel`.
///
/// # Errors
/// If the wheel cannot be built, or a test fails.
pub fn run(arguments: &[String]) -> Result<()> {
    // The tests of pictures need a Vulkan driver.
    setup::ensure_requirements()?;
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let outcome = match words[..] {
        [] => test(Build::Release, &mut Filter::default())?,
        ["--quick"] => test(Build::Quick, &mut Filter::default())?,
        ["--compare"] => return compare(&root().join(SHARED.0), SHARED.1),
        // Relative to the user's working directory; other programs start in the root of the repository.
        ["--compare", file, spacing] => return compare(&std::path::absolute(file)?, spacing),
        ["--python", ref interpreters @ ..] if !interpreters.is_empty() => others(interpreters)?,
        _ => bail!(
            "wheel takes --quick, --compare [PARTICLES.npy SPACING], --python INTERPRETER ... or nothing, got {}",
            words.join(" ")
        ),
    };
    match outcome {
        Outcome::Passed => Ok(()),
        Outcome::Failed(reason) | Outcome::Skipped(reason) => bail!("{reason}"),
    }
}

/// The layer of `cargo xtask test --all`.
///
/// # Errors
/// If a program cannot be started.
pub fn layer(filter: &mut Filter) -> Result<Outcome> {
    test(Build::Quick, filter)
}

fn test(build: Build, filter: &mut Filter) -> Result<Outcome> {
    let lints =
        ["clippy", "--package", "splashdown-py", "--all-targets", "--quiet", "--", "--deny", "warnings"];
    let lints = succeeds(&mut cargo(lints))?;
    if lints != Outcome::Passed {
        return Ok(lints);
    }
    let wheel = match make(build) {
        Ok(wheel) => wheel,
        Err(error) => return Ok(Outcome::Failed(format!("{error:#}"))),
    };
    let bytes = fs::metadata(&wheel.path)?.len();
    let name = wheel.path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    say(format!("{name}: {:.1} MB, built in {:.0} s", 1e-6 * bytes as f64, wheel.seconds));
    say(format!("import splashdown: {}", smoke(&wheel.path)?));
    pytest(None, &wheel.path, filter)
}

/// Tests the wheel that was built last with other interpreters, such as `python3.13`. The wheel is the same for all
/// versions of Python.
fn others(interpreters: &[&str]) -> Result<Outcome> {
    let wheel = built(&dist()).context("build the wheel first, with `cargo xtask wheel`")?;
    for interpreter in interpreters {
        say(format!("{}, {interpreter}:", wheel.display()));
        let outcome = pytest(Some(interpreter), &wheel, &mut Filter::default())?;
        if outcome != Outcome::Passed {
            return Ok(outcome);
        }
    }
    Ok(Outcome::Passed)
}

/// Runs the tests of the package with an interpreter; `None`: that of the system.
fn pytest(interpreter: Option<&str>, wheel: &Path, filter: &mut Filter) -> Result<Outcome> {
    let name = match interpreter {
        None => "tests".to_owned(),
        Some(interpreter) => {
            let version = "import sys; print('%d.%d' % sys.version_info[:2])";
            let output = command(interpreter).args(["-c", version]).output();
            let output = output.with_context(|| format!("cannot start {interpreter}"))?;
            format!("tests-{}", String::from_utf8_lossy(&output.stdout).trim())
        }
    };
    let python = python::environment(interpreter, &folder().join(name), &list("tests.txt"))?;
    install(&python, wheel, &["--no-deps", "--force-reinstall"])?;
    let mut tests = command(&python);
    // With this capture the lines of skipped tests reach stderr.
    tests.args(["-m", "pytest", "--capture=sys", "-q", "-p", "no:cacheprovider"]);
    tests.current_dir(root().join("crates/splashdown-py"));
    layers::tests(&mut tests, filter, None)
}

/// Compares the surface reconstruction with pysplashsurf and writes `docs/python-surface.md`.
fn compare(particles: &Path, spacing: &str) -> Result<()> {
    ensure!(
        particles.exists(),
        "{} does not exist; give particles (.npy, float32, N x 3) and their spacing in m",
        particles.display()
    );
    let wheel = make(Build::Release)?;
    let python = python::environment(None, &folder().join("tests"), &list("tests.txt"))?;
    install(&python, &wheel.path, &["--no-deps", "--force-reinstall"])?;
    let mut script = command(&python);
    script.arg("crates/splashdown-py/wheel/compare.py").arg(particles).arg(spacing);
    script.arg("docs/python-surface.md").env("RAYON_NUM_THREADS", report::threads().to_string());
    process::run(&mut script)
}

/// Builds the wheel and the source distribution into an empty folder, and checks what a package index reads of them.
fn make(build: Build) -> Result<Wheel> {
    let python = python::environment(None, &folder().join("build"), &list("build.txt"))?;
    let out = dist();
    if out.exists() {
        fs::remove_dir_all(&out).with_context(|| format!("cannot empty {}", out.display()))?;
    }
    let maturin = |action: &str| {
        let mut maturin = command(&python);
        maturin.args(["-m", "maturin", action, "--manifest-path"]);
        maturin.arg("crates/splashdown-py/Cargo.toml").arg("--out").arg(&out);
        maturin
    };
    let start = Instant::now();
    let mut wheel = maturin("build");
    wheel.args(["--quiet", "--locked"]);
    process::run(match build {
        Build::Release => wheel.arg("--release"),
        Build::Quick => wheel.args(["--profile", "dev", "--no-default-features"]),
    })?;
    let seconds = start.elapsed().as_secs_f64();
    let path = built(&out)?;
    process::run(&mut maturin("sdist"))?;
    let files = fs::read_dir(&out)?.map(|entry| Ok(entry?.path())).collect::<std::io::Result<Vec<_>>>()?;
    process::run(command(&python).args(["-m", "twine", "--no-color", "check", "--strict"]).args(files))?;
    Ok(Wheel { path, seconds })
}

/// The only wheel in a folder.
fn built(folder: &Path) -> Result<PathBuf> {
    let entries = fs::read_dir(folder).with_context(|| format!("cannot read {}", folder.display()))?;
    let files = entries.map(|entry| Ok(entry?.path())).collect::<std::io::Result<Vec<_>>>()?;
    let wheels: Vec<_> =
        files.into_iter().filter(|path| path.extension().is_some_and(|e| e == "whl")).collect();
    match &wheels[..] {
        [wheel] => Ok(wheel.clone()),
        _ => bail!("{} contains {} wheels instead of one", folder.display(), wheels.len()),
    }
}

/// Installs the wheel and what it requires into an empty environment, and checks it there. Returns the time of its
/// import.
fn smoke(wheel: &Path) -> Result<String> {
    let empty = folder().join("empty");
    if empty.exists() {
        fs::remove_dir_all(&empty).with_context(|| format!("cannot empty {}", empty.display()))?;
    }
    let python = python::create(None, &empty)?;
    install(&python, wheel, &[])?;
    let output = command(&python).arg(root().join("crates/splashdown-py/wheel/smoke.py")).output()?;
    let (out, err) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    ensure!(output.status.success(), "the wheel does not work in an empty environment:\n{out}{err}");
    Ok(out.lines().last().unwrap_or_default().to_owned())
}

fn install(python: &Path, wheel: &Path, arguments: &[&str]) -> Result<()> {
    let mut pip = command(python);
    pip.args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check"]);
    process::run(pip.args(arguments).arg(wheel))
}

fn folder() -> PathBuf {
    target().join("wheel")
}

fn dist() -> PathBuf {
    folder().join("dist")
}

fn list(name: &str) -> PathBuf {
    root().join("crates/splashdown-py/wheel").join(name)
}
