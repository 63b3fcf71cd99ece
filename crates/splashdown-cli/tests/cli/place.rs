//! Shared by the tests of the command line: a small scene, a temporary folder, the program, and its output.

use std::path::{Path, PathBuf};
use std::process::Output;

use assert_cmd::Command;
use serde_json::Value;
use tempfile::TempDir;

/// A result that a test can return.
pub type Outcome = Result<(), Box<dyn std::error::Error>>;

/// 216 particles in a box and two frames of 5 ms, which take a fraction of a second.
pub const SMALL: &str = "\
[scene]
name = \"small\"
duration = 0.01
frame_rate = 200

[domain]
min = [0, 0, 0]
max = [1, 1, 0.3]
open = [\"y_max\"]

[fluid]
particle_spacing = 0.05

[[fluid.block]]
position = [0, 0, 0]
size = [0.3, 0.3, 0.3]

[output]
picture_size = [96, 64]
";

/// A folder for one test, with the small scene in it.
pub struct Place {
    folder: TempDir,
}

impl Place {
    pub fn new() -> std::io::Result<Self> {
        let place = Self { folder: tempfile::tempdir()? };
        place.write("small.toml", SMALL)?;
        Ok(place)
    }

    /// A path in the folder.
    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Writes a file into the folder.
    pub fn write(&self, name: &str, text: impl AsRef<[u8]>) -> std::io::Result<PathBuf> {
        let path = self.path(name);
        std::fs::write(&path, text)?;
        Ok(path)
    }

    /// The program, started in the folder.
    pub fn splashdown(&self, arguments: &[&str]) -> Command {
        let mut command = splashdown(arguments);
        command.current_dir(self.folder.path());
        command
    }

    /// `run small.toml --out out --device cpu` without pictures, and more arguments.
    pub fn run_small(&self, more: &[&str]) -> Command {
        let mut command =
            self.splashdown(&["run", "small.toml", "--out", "out", "--device", "cpu", "--no-pictures"]);
        command.args(more);
        command
    }
}

/// The program with these arguments.
pub fn splashdown(arguments: &[&str]) -> Command {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin!("splashdown"));
    command.args(arguments).timeout(std::time::Duration::from_secs(120));
    command
}

/// The text on stdout.
pub fn stdout(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// The text on stderr.
pub fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// The JSON lines on stdout.
pub fn lines(output: &Output) -> Result<Vec<Value>, serde_json::Error> {
    stdout(output).lines().map(serde_json::from_str).collect()
}

/// The names of the files in a folder, in order.
pub fn names(folder: &Path) -> std::io::Result<Vec<String>> {
    let mut names = Vec::new();
    for entry in std::fs::read_dir(folder)? {
        names.push(entry?.file_name().to_string_lossy().into_owned());
    }
    names.sort();
    Ok(names)
}

/// Asserts one clear error: the exit code, no panic, and an error message on stderr that contains all words.
pub fn assert_refused(output: &Output, code: i32, words: &[&str]) {
    let text = stderr(output);
    assert_eq!(output.status.code(), Some(code), "{text}");
    assert!(text.contains("error"), "{text}");
    assert!(!text.contains("panicked"), "{text}");
    for word in words {
        assert!(text.contains(word), "`{word}` is missing in:\n{text}");
    }
}

/// Whether a driver can draw. With `CI=true` a missing driver is a failure.
pub fn can_draw() -> bool {
    let output = splashdown(&["doctor", "--json"]).output();
    let doctor = output.ok().and_then(|output| serde_json::from_slice::<Value>(&output.stdout).ok());
    let found = doctor.is_some_and(|doctor| doctor["draws_on"].is_string());
    if !found {
        assert!(
            std::env::var("CI").as_deref() != Ok("true"),
            "with CI=true a driver that can draw is required"
        );
        eprintln!("SKIPPED: no driver to draw pictures with");
    }
    found
}

/// A small file system, unmounted when dropped.
#[cfg(target_os = "linux")]
pub struct TinyDisk(pub PathBuf);

#[cfg(target_os = "linux")]
impl TinyDisk {
    /// Mounts a file system of `size` KiB; `None` if that is not possible.
    pub fn mount(folder: PathBuf, size: u32) -> std::io::Result<Option<Self>> {
        std::fs::create_dir(&folder)?;
        let mount = Command::new("mount")
            .args(["-t", "tmpfs", "-o", &format!("size={size}k"), "tmpfs"])
            .arg(&folder)
            .output();
        Ok(mount.is_ok_and(|output| output.status.success()).then_some(Self(folder)))
    }
}

#[cfg(target_os = "linux")]
impl Drop for TinyDisk {
    fn drop(&mut self) {
        let _ = Command::new("umount").arg("--lazy").arg(&self.0).output();
    }
}
