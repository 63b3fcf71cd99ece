//! Compares the public API of the library crates with that of an earlier commit, using `cargo-semver-checks`.
//!
//! The tool alone would compile every dependency again, twice per crate. Here `cargo doc` describes both states
//! instead, with the artifacts that the other layers of `cargo xtask test` have built, and the tool compares the
//! descriptions. Those of the earlier commit are cached in `target/api`.

use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result, ensure};

use crate::layers::Outcome;
use crate::names;
use crate::process::{self, cargo, command, root, say};

/// The crates whose API is compared.
const CRATES: [&str; 6] = [
    "splashdown",
    "splashdown-gpu",
    "splashdown-io",
    "splashdown-render",
    "splashdown-run",
    "splashdown-viewer",
];

/// The file that names the commit with the API to compare with.
const BASELINE: &str = ".semver-baseline";

const TOOL: &str = "cargo-semver-checks";
const TOOL_VERSION: &str = "0.51.0";

/// Set while this program replaces rustdoc: the folder of the descriptions.
const OUTPUT: &str = "SPLASHDOWN_API_OUTPUT";

/// The flags of rustdoc for a description of the items that users see.
const PUBLIC: &str = "-Zunstable-options --output-format=json --cap-lints=allow";

/// The flags of rustdoc with which the tool itself describes a crate.
const EVERYTHING: &str = "-Zunstable-options --output-format=json --document-private-items \
                          --document-hidden-items --cap-lints=allow";

/// The command `api`: checks the names, and compares with the tool, which is installed if necessary.
pub fn run(arguments: &[String]) -> Result<()> {
    ensure!(arguments.is_empty(), "api takes no arguments, got {}", arguments.join(" "));
    for check in [check_names, || layer(true)] {
        let outcome = check()?;
        if let Outcome::Failed(reason) | Outcome::Skipped(reason) = outcome {
            anyhow::bail!("{reason}");
        }
    }
    Ok(())
}

/// The layer of `cargo xtask test`. A missing tool is installed with `install`, which takes several minutes once, and
/// skips the layer without it. The layer is also skipped if the installation fails, for example without a registry.
pub fn layer(install: bool) -> Result<Outcome> {
    let tool = match tool() {
        Some(tool) => tool,
        None if install => match install_tool() {
            Ok(tool) => tool,
            Err(error) => {
                return Ok(Outcome::Skipped(format!("{TOOL} {TOOL_VERSION} cannot be installed: {error:#}")));
            }
        },
        None => {
            let reason = format!("{TOOL} {TOOL_VERSION} is not installed; `cargo xtask api` installs it");
            return Ok(Outcome::Skipped(reason));
        }
    };
    let baseline = baseline()?;
    let compiler = compiler()?;
    let folder = process::target().join("api");
    let old = folder.join(format!("{baseline}-{compiler}"));
    if !old.exists() {
        say(format!("Describing the API of {baseline} ..."));
        describe_commit(&baseline, &folder.join("source"), &old)?;
    }
    say("Describing the API of the working tree ...");
    let new = folder.join(format!("current-{compiler}"));
    describe(root(), &new, EVERYTHING)?;
    let mut broken = Vec::new();
    for name in CRATES {
        let file = format!("{}.json", name.replace('-', "_"));
        match (old.join(&file), new.join(&file)) {
            (_, new) if !new.exists() => say(format!("{name}: not in this workspace")),
            (old, _) if !old.exists() => say(format!("{name}: new since the baseline")),
            (old, new) if !compatible(&tool, &old, &new)? => broken.push(name),
            _ => say(format!("{name}: compatible")),
        }
    }
    if broken.is_empty() {
        return Ok(Outcome::Passed);
    }
    Ok(Outcome::Failed(format!(
        "the API of {} differs from {baseline} more than the version allows; raise the version, or set {BASELINE} \
         (see docs/releasing.md)",
        broken.join(", ")
    )))
}

/// Checks that every type in a public signature of the main library has a public name.
///
/// # Errors
/// If rustdoc fails.
pub fn check_names() -> Result<Outcome> {
    let folder = process::target().join("api").join("public");
    describe(root(), &folder, PUBLIC)?;
    let unnamed = names::check(&folder.join("splashdown.json"))?;
    if unnamed.is_empty() {
        return Ok(Outcome::Passed);
    }
    Ok(Outcome::Failed(format!(
        "users cannot name these types; re-export them, or hide what uses them with `#[doc(hidden)]`:\n  {}",
        unnamed.join("\n  ")
    )))
}

/// The tool, if this version of it is installed in the target folder or on the path.
fn tool() -> Option<PathBuf> {
    let own = tools_folder().join("bin").join(format!("{TOOL}{}", std::env::consts::EXE_SUFFIX));
    [own, PathBuf::from(TOOL)].into_iter().find(|path| {
        let output = command(path).args(["semver-checks", "--version"]).output();
        output.is_ok_and(|output| String::from_utf8_lossy(&output.stdout).trim().ends_with(TOOL_VERSION))
    })
}

fn tools_folder() -> PathBuf {
    process::target().join("tools")
}

/// Compiles the tool without optimization: an optimized build takes longer than the comparison.
fn install_tool() -> Result<PathBuf> {
    say(format!("Installing {TOOL} {TOOL_VERSION} into {} ...", tools_folder().display()));
    let build = tools_folder().join("build");
    let mut install = cargo(["install", TOOL, "--version", TOOL_VERSION, "--locked", "--debug", "--quiet"]);
    install.arg("--root").arg(tools_folder()).env("CARGO_TARGET_DIR", &build);
    install.envs([("CARGO_PROFILE_DEV_DEBUG", "0"), ("CARGO_PROFILE_DEV_OPT_LEVEL", "0")]);
    process::run(&mut install)?;
    fs::remove_dir_all(&build).with_context(|| format!("cannot remove {}", build.display()))?;
    tool().with_context(|| format!("{TOOL} was installed but does not start"))
}

/// The full id of the commit that the file names: an id, a branch or a tag. Lines with `#` are comments.
fn baseline() -> Result<String> {
    let text =
        fs::read_to_string(root().join(BASELINE)).with_context(|| format!("cannot read {BASELINE}"))?;
    let name = revision(&text).with_context(|| format!("{BASELINE} names no commit"))?;
    let commit = format!("{name}^{{commit}}");
    let output = command("git").args(["rev-parse", "--verify", "--quiet", &commit]).output()?;
    ensure!(
        output.status.success(),
        "{BASELINE} names {name}, which this clone does not have; a shallow clone needs `git fetch --unshallow`"
    );
    Ok(String::from_utf8_lossy(&output.stdout).trim().to_owned())
}

fn revision(text: &str) -> Option<&str> {
    text.lines().map(str::trim).find(|line| !line.is_empty() && !line.starts_with('#'))
}

/// A short name of the compiler: descriptions of different compilers have different formats.
fn compiler() -> Result<String> {
    let output = command("rustc").arg("--version").output().context("cannot start rustc")?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    Ok(text.split_whitespace().nth(1).unwrap_or("unknown").to_owned())
}

/// Describes the crates of a commit, from a copy of its files.
fn describe_commit(commit: &str, source: &Path, output: &Path) -> Result<()> {
    if source.exists() {
        fs::remove_dir_all(source)?;
    }
    fs::create_dir_all(source)?;
    let archive = source.join("archive.tar");
    process::run(command("git").args(["archive", "--format=tar", "--output"]).arg(&archive).arg(commit))?;
    process::run(command("tar").arg("-xf").arg(&archive).arg("-C").arg(source))?;
    // Renamed when complete, so that an interrupted run leaves no partial result.
    let partial = output.with_extension("partial");
    describe(source, &partial, EVERYTHING)?;
    fs::rename(&partial, output)?;
    fs::remove_dir_all(source)?;
    Ok(())
}

/// Describes every crate of a workspace. The selection of packages is that of the documentation layer, so that
/// cargo chooses the same features and finds its dependencies compiled.
fn describe(workspace: &Path, output: &Path, flags: &str) -> Result<()> {
    fs::create_dir_all(output)?;
    let mut doc = cargo(["doc", "--workspace", "--exclude", "xtask", "--no-deps", "--quiet"]);
    doc.args(["--exclude", "splashdown-py"]);
    doc.current_dir(workspace).env("CARGO_TARGET_DIR", process::target());
    doc.env("RUSTDOC", std::env::current_exe()?).env(OUTPUT, output).env("RUSTDOCFLAGS", flags);
    process::run(&mut doc)
}

/// Replaces rustdoc if `describe` has started this program. It differs in two points: unstable flags are allowed,
/// and the output goes to a separate folder. `RUSTC_BOOTSTRAP` is not set for cargo itself: build scripts would
/// react to it, and every dependency would be compiled again.
pub fn as_rustdoc() -> Option<ExitCode> {
    let output = std::env::var_os(OUTPUT)?;
    let arguments = with_output(std::env::args_os().skip(1).collect(), &output);
    let status = std::process::Command::new("rustdoc").args(arguments).env("RUSTC_BOOTSTRAP", "1").status();
    Some(match status {
        Ok(status) if status.success() => ExitCode::SUCCESS,
        Ok(_) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("error: cannot start rustdoc: {error}");
            ExitCode::FAILURE
        }
    })
}

/// The arguments with another folder after `-o`.
fn with_output(mut arguments: Vec<OsString>, output: &OsString) -> Vec<OsString> {
    if let Some(at) = arguments.iter().position(|argument| argument == "-o" || argument == "--out-dir")
        && let Some(folder) = arguments.get_mut(at + 1)
    {
        folder.clone_from(output);
    }
    arguments
}

/// True if the tool finds no breaking change beyond those that the versions allow. The tool prints its findings.
fn compatible(tool: &Path, old: &Path, new: &Path) -> Result<bool> {
    let mut check = command(tool);
    check.args(["semver-checks", "--baseline-rustdoc"]).arg(old).arg("--current-rustdoc").arg(new);
    Ok(check.status().with_context(|| format!("cannot start {TOOL}"))?.success())
}

#[cfg(test)]
mod tests {
    use super::{revision, with_output};

    #[test]
    fn the_first_line_that_is_not_a_comment_names_the_commit() {
        assert_eq!(revision("# why\n\n v1.0.0 \nother\n"), Some("v1.0.0"));
        assert_eq!(revision("# why\n"), None);
    }

    #[test]
    fn only_the_output_folder_of_rustdoc_is_replaced() {
        let given = ["--crate-name", "a", "-o", "target/doc", "src/lib.rs"].map(Into::into).to_vec();
        let wanted = ["--crate-name", "a", "-o", "elsewhere", "src/lib.rs"].map(std::ffi::OsString::from);
        assert_eq!(with_output(given, &"elsewhere".into()), wanted);
    }
}
