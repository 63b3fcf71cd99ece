//! Installs the Python packages with which tests open files, in a separate environment in the target folder, so that
//! the user's packages stay unchanged.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};

use crate::process::{self, command, root, say, target};

/// The packages that the default tests use.
const USUAL: &str = "requirements.txt";
/// Blender: a download of 370 MB, for two tests.
const BLENDER: &str = "blender.txt";

/// Creates the environment and installs missing packages; Blender only with `all`. Tests whose packages cannot be
/// installed are skipped and report it.
pub fn ensure(all: bool) {
    let folder = target().join("python");
    for list in [Some(USUAL), all.then_some(BLENDER)].into_iter().flatten() {
        let path = root().join("crates/splashdown-io/tests/foreign").join(list);
        if let Err(error) = install(None, &folder, &path) {
            say(format!(
                "WARNING: Python packages of {list} are missing: {error:#}. Tests that open files with them will be skipped."
            ));
        }
    }
}

/// Creates an environment in a folder, installs a list of packages into it unless they are installed, and returns its
/// interpreter. `system` is the interpreter that creates it; `None`: that of the system.
///
/// # Errors
/// If Python is missing or a package cannot be installed.
pub fn environment(system: Option<&str>, folder: &Path, list: &Path) -> Result<PathBuf> {
    install(system, folder, list)?;
    Ok(interpreter(folder))
}

/// Creates an environment in a folder unless it exists, and returns its interpreter.
///
/// # Errors
/// If Python is missing.
pub fn create(system: Option<&str>, folder: &Path) -> Result<PathBuf> {
    let python = interpreter(folder);
    if !python.exists() {
        let found = if process::exists("python3", "--version") { "python3" } else { "python" };
        process::run(command(system.unwrap_or(found)).args(["-m", "venv"]).arg(folder))?;
    }
    Ok(python)
}

fn install(system: Option<&str>, folder: &Path, list: &Path) -> Result<()> {
    let wanted = fs::read_to_string(list).with_context(|| format!("cannot read {}", list.display()))?;
    // A copy of the installed list is stored in the environment, so that a second call costs nothing.
    let note = folder.join(list.file_name().unwrap_or_default());
    if fs::read_to_string(&note).is_ok_and(|installed| installed == wanted) {
        return Ok(());
    }
    let python = create(system, folder)?;
    say(format!("Installing Python packages of {} into {} ...", list.display(), folder.display()));
    let mut pip = command(&python);
    pip.args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--requirement"]);
    process::run(pip.arg(list))?;
    Ok(fs::write(&note, wanted)?)
}

/// The interpreter of the environment.
fn interpreter(folder: &Path) -> PathBuf {
    folder.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" })
}
