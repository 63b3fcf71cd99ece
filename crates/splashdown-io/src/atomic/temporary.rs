//! The temporary file that becomes the complete file.
//!
//! On Linux it has no name (`O_TMPFILE`) and gets one when it is complete, so the system removes it however the process
//! ends. Elsewhere, and on file systems without this, it has a hidden name, which a killed process leaves behind;
//! the next run in the same folder removes it.

use std::ffi::OsString;
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::process::Stdio;
use std::sync::atomic::{AtomicU64, Ordering};

use super::{sync_file, sync_parent};

/// A file without a name, or with a hidden name, removed on drop unless it was [persisted](Temporary::persist).
#[derive(Debug)]
pub(crate) struct Temporary {
    file: File,
    /// The hidden name, if there is one.
    name: Option<PathBuf>,
}

impl Temporary {
    /// Creates a file for writing and reading in the folder of `path`.
    pub(crate) fn create(path: &Path) -> io::Result<Self> {
        if let Some(file) = unnamed(path) {
            return Ok(Self { file, name: None });
        }
        let name = hidden_name(path);
        let file = File::options().read(true).write(true).create_new(true).open(&name)?;
        Ok(Self { file, name: Some(name) })
    }

    /// The open file.
    pub(crate) fn file(&self) -> &File {
        &self.file
    }

    /// For a child process that writes the file: its name, and the standard output under which the child knows it.
    pub(crate) fn for_child(&self) -> io::Result<(OsString, Stdio)> {
        Ok(match &self.name {
            Some(name) => (name.clone().into_os_string(), Stdio::null()),
            None => (OsString::from("/proc/self/fd/1"), self.file.try_clone()?.into()),
        })
    }

    /// Flushes the file to the disk and gives it its name; an existing file is replaced in one step.
    pub(crate) fn persist(self, path: &Path) -> io::Result<()> {
        sync_file(&self.file)?;
        match &self.name {
            Some(name) => fs::rename(name, path)?,
            None => link(&self.file, path)?,
        }
        sync_parent(path)
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        if let Some(name) = &self.name {
            // After a rename there is no file to remove. A failure here would only hide an earlier one.
            let _ = fs::remove_file(name);
        }
    }
}

/// A hidden name that no other process and no other call in this process uses.
fn hidden_name(path: &Path) -> PathBuf {
    static NEXT: AtomicU64 = AtomicU64::new(0);
    let number = NEXT.fetch_add(1, Ordering::Relaxed);
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!(".{name}.{}-{number}.partial", std::process::id()))
}

/// A file without a name, if the system, the file system and `/proc` support it.
#[cfg(target_os = "linux")]
fn unnamed(path: &Path) -> Option<File> {
    use rustix::fs::{Mode, OFlags};
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let flags = OFlags::TMPFILE | OFlags::RDWR | OFlags::CLOEXEC;
    let file = File::from(rustix::fs::open(folder, flags, Mode::from_raw_mode(0o666)).ok()?);
    Path::new(&entry(&file)).exists().then_some(file)
}

#[cfg(not(target_os = "linux"))]
fn unnamed(_: &Path) -> Option<File> {
    None
}

/// Names a file without a name.
#[cfg(target_os = "linux")]
fn link(file: &File, path: &Path) -> io::Result<()> {
    use rustix::fs::{AtFlags, CWD, linkat};
    let link = |to: &Path| linkat(CWD, entry(file), CWD, to, AtFlags::SYMLINK_FOLLOW);
    match link(path) {
        Err(rustix::io::Errno::EXIST) => {
            // A link replaces no file, so the file gets a hidden name for the moment until it is renamed.
            let name = hidden_name(path);
            link(&name)?;
            fs::rename(&name, path).inspect_err(|_| drop(fs::remove_file(&name)))
        }
        result => Ok(result?),
    }
}

#[cfg(not(target_os = "linux"))]
fn link(_: &File, _: &Path) -> io::Result<()> {
    unreachable!("files have names on this system")
}

/// The path of an open file.
#[cfg(target_os = "linux")]
fn entry(file: &File) -> String {
    use std::os::fd::AsRawFd as _;
    format!("/proc/self/fd/{}", file.as_raw_fd())
}
