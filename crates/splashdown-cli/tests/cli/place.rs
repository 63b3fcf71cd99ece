//! What the tests of the command line share: a small scene, the program, and what it printed.

use std::path::{Path, PathBuf};
use std::process::Output;

use assert_cmd::Command;
use serde_json::Value;
use tempfile::TempDir;

/// A result that a test can return.
pub type Outcome = Result<(), Box<dyn std::error::Error>>;

/// 216 particles in a box, two frames of 5 ms: a fraction of a second.
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

/// What came on stdout.
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

/// One clear error: the exit code, no panic, and a message on stderr that says all this.
pub fn assert_refused(output: &Output, code: i32, words: &[&str]) {
    let text = stderr(output);
    assert_eq!(output.status.code(), Some(code), "{text}");
    assert!(text.contains("error"), "{text}");
    assert!(!text.contains("panicked"), "{text}");
    for word in words {
        assert!(text.contains(word), "`{word}` is missing in:\n{text}");
    }
}

/// True if something can draw here. Where a driver is promised (`CI=true`) it must be there.
pub fn can_draw() -> bool {
    let output = splashdown(&["doctor", "--json"]).output();
    let doctor = output.ok().and_then(|output| serde_json::from_slice::<Value>(&output.stdout).ok());
    let found = doctor.is_some_and(|doctor| doctor["draws_on"].is_string());
    if !found {
        assert!(std::env::var("CI").as_deref() != Ok("true"), "CI=true, and there is no driver to draw with");
        eprintln!("SKIPPED: no driver to draw pictures with");
    }
    found
}

/// A small file system; gone when dropped.
#[cfg(target_os = "linux")]
pub struct TinyDisk(pub PathBuf);

#[cfg(target_os = "linux")]
impl TinyDisk {
    /// Of this many KiB; `None` where none can be mounted.
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
