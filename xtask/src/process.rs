//! Starts other programs, always from the repository root and with a runtime folder that the Vulkan loader
//! accepts.

use std::ffi::OsStr;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

use anyhow::{Context, Result, ensure};

/// Prints a line. A closed pipe (`cargo xtask help | head -1`) does not cause a panic.
pub fn say(text: impl AsRef<str>) {
    let _ = writeln!(std::io::stdout().lock(), "{}", text.as_ref());
}

/// The root of the workspace. Cargo passes it at run time; the value from build time may be another clone if clones
/// share a target folder.
pub fn root() -> &'static Path {
    static FOLDER: OnceLock<PathBuf> = OnceLock::new();
    let find = || {
        let package =
            std::env::var_os("CARGO_MANIFEST_DIR").unwrap_or_else(|| env!("CARGO_MANIFEST_DIR").into());
        Path::new(&package).parent().unwrap_or(Path::new(".")).to_owned()
    };
    FOLDER.get_or_init(find)
}

/// A command that starts in the repository root.
pub fn command(program: impl AsRef<OsStr>) -> Command {
    let mut command = Command::new(program);
    command.current_dir(root());
    if let Some(folder) = runtime_folder() {
        command.env("XDG_RUNTIME_DIR", folder);
    }
    if is_ci() {
        // A build that runs once does not need the incremental state, which takes as much disk space as everything
        // else, nor line numbers in backtraces, which make test programs twice as large.
        command.env("CARGO_INCREMENTAL", "0").env("CARGO_PROFILE_DEV_DEBUG", "0");
        // Downloaded packages would be stored a second time.
        command.env("PIP_NO_CACHE_DIR", "1");
    }
    command
}

/// Cargo itself, the one that runs this program.
pub fn cargo<I: IntoIterator<Item = S>, S: AsRef<OsStr>>(arguments: I) -> Command {
    let mut command = command(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.args(arguments);
    command
}

/// The target folder of cargo.
pub fn target() -> PathBuf {
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| PathBuf::from("target"), PathBuf::from);
    root().join(target)
}

/// Removes a folder below the target folder that no later layer uses: in continuous integration disk space is scarce, and
/// nothing is built twice.
pub fn discard(folder: &str) {
    if is_ci() {
        // A folder that stays is harmless, so failure is ignored.
        let _ = std::fs::remove_dir_all(target().join(folder));
    }
}

/// Builds the command line in release mode and returns the path of the binary.
pub fn build_release() -> Result<PathBuf> {
    build_release_with(&[])
}

/// As [`build_release`], with further arguments of `cargo build`, such as features.
pub fn build_release_with(arguments: &[&str]) -> Result<PathBuf> {
    say("Building (release) ...");
    run(cargo(["build", "--release", "--package", "splashdown-cli"]).args(arguments))?;
    let binary = target().join("release").join(format!("splashdown{}", std::env::consts::EXE_SUFFIX));
    ensure!(binary.exists(), "the build succeeded, but {} does not exist", binary.display());
    Ok(binary)
}

/// Builds the tests, and with them the command line that they run; returns its path. After the tests nothing is left to
/// compile. `cargo build --profile test` would compile everything again, with the features of other dependencies.
pub fn build_tested() -> Result<PathBuf> {
    let extent = ["--workspace", "--exclude", "splashdown-py", "--no-run"];
    run(cargo(["test", "--quiet"]).args(extent).stdout(std::process::Stdio::null()))?;
    let binary = target().join("debug").join(format!("splashdown{}", std::env::consts::EXE_SUFFIX));
    ensure!(binary.exists(), "the tests were built, but {} does not exist", binary.display());
    Ok(binary)
}

/// Runs a command to its end; an error if it cannot start or fails.
pub fn run(command: &mut Command) -> Result<()> {
    let words = line(command);
    let status = command.status().with_context(|| format!("cannot start `{words}`"))?;
    ensure!(status.success(), "`{words}` failed ({status})");
    Ok(())
}

/// The command as typed in a shell.
pub fn line(command: &Command) -> String {
    let name = Path::new(command.get_program()).file_stem().unwrap_or_default();
    let words = std::iter::once(name).chain(command.get_args());
    words.map(|word| word.to_string_lossy()).collect::<Vec<_>>().join(" ")
}

/// True if a program starts and accepts the argument.
pub fn exists(program: &str, argument: &str) -> bool {
    let mut command = Command::new(program);
    command.arg(argument).stdin(std::process::Stdio::null());
    command.stdout(std::process::Stdio::null()).stderr(std::process::Stdio::null());
    command.status().is_ok_and(|status| status.success())
}

/// True if a program can be started, even if it rejects the argument.
pub fn exists_at_all(program: &str, argument: &str) -> bool {
    let mut command = Command::new(program);
    command.arg(argument).stdin(std::process::Stdio::null());
    command.stdout(std::process::Stdio::null()).stderr(std::process::Stdio::null());
    command.status().is_ok()
}

/// True in continuous integration, where a missing driver is an error instead of a reason to skip.
pub fn is_ci() -> bool {
    std::env::var("CI").is_ok_and(|value| value == "true" || value == "1")
}

/// A private folder for `XDG_RUNTIME_DIR` if the system sets none: without it, software Vulkan prints many
/// messages to stderr.
#[cfg(target_os = "linux")]
fn runtime_folder() -> Option<&'static Path> {
    use std::os::unix::fs::DirBuilderExt;
    static FOLDER: OnceLock<Option<PathBuf>> = OnceLock::new();
    let make = || {
        if std::env::var_os("XDG_RUNTIME_DIR").is_some() {
            return None;
        }
        let folder = std::env::temp_dir().join(format!("splashdown-runtime-{}", std::process::id()));
        std::fs::DirBuilder::new().mode(0o700).create(&folder).ok()?;
        Some(folder)
    };
    FOLDER.get_or_init(make).as_deref()
}

/// Other systems have no such folder.
#[cfg(not(target_os = "linux"))]
fn runtime_folder() -> Option<&'static Path> {
    static NONE: OnceLock<Option<PathBuf>> = OnceLock::new();
    NONE.get_or_init(|| None).as_deref()
}

/// Removes this run's files from the system's temporary folder.
pub fn clean_up() {
    if let Some(folder) = runtime_folder() {
        // A leftover temporary folder is harmless, so failure is ignored.
        let _ = std::fs::remove_dir_all(folder);
    }
}
