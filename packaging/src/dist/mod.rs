//! `cargo xtask dist`: archives of the program for every target that this machine can build, a Debian package, and
//! checksums.
//!
//! Every file of an archive has the time of the last commit and a fixed owner, so that the same commit and the same
//! compiler give the same archive.

mod archive;
mod checksum;
mod deb;
mod extras;
mod licences;
mod man;
mod smoke;
mod stage;
mod target;

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};

use crate::command::{cargo, output, program, root, run as execute, say};
use crate::metadata::Metadata;
use target::Target;

/// The package whose binary is released.
const PACKAGE: &str = "splashdown-cli";

/// The options of the command line.
#[derive(Debug, Default)]
struct Options {
    targets: Vec<String>,
    skip_checks: bool,
}

impl Options {
    fn parse(arguments: &[String]) -> Result<Self> {
        let mut options = Self::default();
        let mut arguments = arguments.iter();
        while let Some(argument) = arguments.next() {
            match argument.as_str() {
                "--target" => {
                    let target = arguments.next().context("--target needs a target triple")?;
                    options.targets.push(target.clone());
                }
                "--no-check" => options.skip_checks = true,
                other => bail!("dist takes --target TRIPLE (repeatable) and --no-check, got {other}"),
            }
        }
        Ok(options)
    }
}

/// A release that is being built.
struct Release {
    version: String,
    /// Seconds since 1970: the time of every file.
    time: u64,
    folder: PathBuf,
    target_folder: PathBuf,
}

/// The command `dist`.
///
/// # Errors
/// If a build, a file or the check of an archive fails.
pub fn run(arguments: &[String]) -> Result<()> {
    let options = Options::parse(arguments)?;
    let targets = target::chosen(&options.targets)?;
    let metadata = Metadata::ask(&["--no-deps", "--offline"])?;
    let package = metadata.packages.iter().find(|package| package.name == PACKAGE);
    let version =
        package.with_context(|| format!("the workspace has no package {PACKAGE}"))?.version.to_string();
    let release = Release {
        time: commit_time(),
        folder: metadata.target_directory.join("dist"),
        target_folder: metadata.target_directory.clone(),
        version,
    };
    fs::create_dir_all(&release.folder)
        .with_context(|| format!("cannot create {}", release.folder.display()))?;
    let mut files = Vec::new();
    for target in &targets {
        files.extend(build(&release, target)?);
    }
    files.push(checksum::write(&release.folder, &files)?);
    if options.targets.is_empty() && !options.skip_checks {
        check_other_systems();
    }
    say("\nWritten:");
    for file in &files {
        say(format!("  {:7.2} MB  {}", fs::metadata(file)?.len() as f64 / 1e6, file.display()));
    }
    Ok(())
}

/// Builds, packs and tests one target, and returns the files.
fn build(release: &Release, target: &Target) -> Result<Vec<PathBuf>> {
    say(format!("\n=== {} ({})", target.triple, target.contents()));
    let binary = compile(release, target)?;
    let stage = stage::collect(release, target, &binary)?;
    let name = format!("splashdown-{}-{}", release.version, target.triple);
    let path = archive::write(&release.folder, &name, &stage, release.time, target.is_windows())?;
    let mut files = vec![path.clone()];
    if target.is_host() {
        smoke::run(&path, &name)?;
    } else {
        say("Not tested: the target is another system.");
    }
    if target.has_debian_package() {
        files.push(deb::write(release, target, &binary, &stage)?);
    }
    Ok(files)
}

/// Compiles the program for a target.
fn compile(release: &Release, target: &Target) -> Result<PathBuf> {
    target.install()?;
    let mut build = cargo(["build", "--release", "--locked", "--package", PACKAGE]);
    build.args(target.features());
    // Without `--target` the host's build shares its dependencies with `cargo xtask demo`.
    let folder = if target.is_host_triple() {
        release.target_folder.join("release")
    } else {
        build.args(["--target", &target.triple]);
        release.target_folder.join(&target.triple).join("release")
    };
    execute(&mut build)?;
    let binary = folder.join(if target.is_windows() { "splashdown.exe" } else { "splashdown" });
    anyhow::ensure!(binary.exists(), "the build succeeded, but {} does not exist", binary.display());
    Ok(binary)
}

/// Type-checks the program for the systems that this machine cannot link for.
fn check_other_systems() {
    for triple in target::checked_elsewhere() {
        say(format!("\n=== {triple}: type check only; its archive is built on that system"));
        let target = Target::new(triple);
        let checked = target.install().and_then(|()| {
            execute(&mut cargo(["check", "--locked", "--package", PACKAGE, "--quiet", "--target", triple]))
        });
        match checked {
            Ok(()) => say("Passed."),
            Err(error) => say(format!("WARNING: {error:#}")),
        }
    }
}

/// The time of the last commit, or the one that the environment sets for reproducible builds.
fn commit_time() -> u64 {
    let variable = std::env::var("SOURCE_DATE_EPOCH").ok();
    let text = variable.or_else(|| output(&mut program("git", root(), ["log", "-1", "--format=%ct"])).ok());
    text.and_then(|text| text.trim().parse().ok()).unwrap_or(0)
}

/// Reads a file; the error names it.
fn read(path: &Path) -> Result<Vec<u8>> {
    fs::read(path).with_context(|| format!("cannot read {}", path.display()))
}
