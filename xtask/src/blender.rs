//! `cargo xtask blender`: packs the Blender extension and tests the package in Blender, installed from PyPI.

use anyhow::{Context, Result, bail, ensure};

use crate::process::{self, root, say, target};
use crate::python;

/// Packs the extension into target/blender and runs its tests; with `--pictures`, also draws those of the guide.
///
/// # Errors
/// If Blender cannot be installed, the program cannot be built, or a test fails.
pub fn run(arguments: &[String]) -> Result<()> {
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let has_pictures = match words[..] {
        [] => false,
        ["--pictures"] => true,
        _ => bail!("blender takes --pictures or nothing, got {}", words.join(" ")),
    };
    let folder = target().join("blender");
    let list = root().join("blender/requirements.txt");
    let python = python::environment(None, &folder.join("env"), &list)
        .context("cannot install Blender as a Python package, which exists for Python 3.11 only")?;
    let output = process::command(&python).arg("blender/package.py").arg(&folder).output()?;
    ensure!(
        output.status.success(),
        "cannot pack the extension:\n{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let zip = String::from_utf8(output.stdout)?.trim().to_owned();
    process::run(process::command(&python).args(["-m", "unittest", "discover", "-s", "blender/tests"]))?;
    let splashdown = process::build_release()?;
    let mut tests = process::command(&python);
    tests.arg("blender/tests/headless.py").arg(&zip).arg(&splashdown).arg(folder.join("work"));
    if has_pictures {
        tests.arg(root().join("docs/pictures/blender"));
    }
    process::run(&mut tests)?;
    say(format!("Written: {zip}"));
    Ok(())
}
