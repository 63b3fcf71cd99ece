//! `cargo xtask blender`: packs the Blender extension and tests the package in Blender, installed from PyPI.

use anyhow::{Context, Result, bail};

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
    let zip = folder.join(format!("splashdown-{}.zip", env!("CARGO_PKG_VERSION")));
    process::run(process::command(&python).arg("blender/package.py").arg(&zip))?;
    process::run(process::command(&python).args([
        "-m",
        "unittest",
        "discover",
        "-s",
        "blender/tests",
        "-p",
        "test_*.py",
    ]))?;
    let splashdown = process::build_release()?;
    let tests = || {
        let mut tests = process::command(&python);
        tests.arg("blender/tests/headless.py").arg(&zip).arg(&splashdown);
        tests
    };
    process::run(&mut tests())?;
    if has_pictures {
        process::run(tests().arg("--pictures").arg(root().join("docs/pictures/blender")))?;
    }
    say(format!("Written: {}", zip.display()));
    Ok(())
}
