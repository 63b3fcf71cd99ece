//! The Python packages with which tests open files: an environment of their own in the target folder, so that
//! nothing of the user's is touched.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};

use crate::process::{self, command, root, say, target};

/// The packages that the usual tests use.
const USUAL: &str = "requirements.txt";
/// Blender: a download of 370 MB, for two tests.
const BLENDER: &str = "blender.txt";

/// Makes the environment and installs what is missing; Blender only if `all` is asked for. Tests whose packages
/// cannot be installed are skipped and print so.
pub fn ensure(all: bool) {
    let folder = target().join("python");
    for list in [Some(USUAL), all.then_some(BLENDER)].into_iter().flatten() {
        let path = root().join("crates/splashdown-io/tests/foreign").join(list);
        if let Err(error) = install(&folder, &path) {
            say(format!(
                "WARNING: Python packages of {list} are missing: {error:#}. Tests that open files with them will be skipped."
            ));
        }
    }
}

/// Makes an environment in a folder, installs a list of packages into it where that has not been done, and
/// returns its interpreter.
///
/// # Errors
/// If Python or a package cannot be had.
pub fn environment(folder: &Path, list: &Path) -> Result<PathBuf> {
    install(folder, list)?;
    Ok(interpreter(folder))
}

fn install(folder: &Path, list: &Path) -> Result<()> {
    let wanted = fs::read_to_string(list).with_context(|| format!("cannot read {}", list.display()))?;
    // What was installed last is noted beside it, so that a second call costs nothing.
    let note = folder.join(list.file_name().unwrap_or_default());
    if fs::read_to_string(&note).is_ok_and(|installed| installed == wanted) {
        return Ok(());
    }
    let python = interpreter(folder);
    if !python.exists() {
        let system = if process::exists("python3", "--version") { "python3" } else { "python" };
        process::run(command(system).args(["-m", "venv"]).arg(folder))?;
    }
    say(format!("Installing Python packages of {} into {} ...", list.display(), folder.display()));
    let mut pip = command(&python);
    pip.args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--requirement"]);
    process::run(pip.arg(list))?;
    Ok(fs::write(&note, wanted)?)
}

/// The environment's own interpreter.
fn interpreter(folder: &Path) -> PathBuf {
    folder.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" })
}
