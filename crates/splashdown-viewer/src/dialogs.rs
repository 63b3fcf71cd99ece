//! The file dialogs of the desktop.
//!
//! # How it works
//! `rfd` asks the portal of the desktop over D-Bus on Linux, or `zenity` without one, and calls the system on Windows and
//! macOS. A thread waits for the answer. Nothing is linked for it: libdbus is loaded when the first dialog opens.
//!
//! # Why not the other way
//! * GTK would have to be linked, and drawn into a window that is not GTK's.
//! * A dialog by egui would not know the bookmarks and the recent folders of the desktop.
//! * The dialogs have no parent: its handle would have to stay valid on another thread until the answer.
//!
//! `rfd` gives the same answer if the user cancels and if there is no dialog at all; it only logs the difference. This
//! module therefore listens to its log.

use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, Once, PoisonError};

use log::{LevelFilter, Log, Metadata, Record};
use rfd::AsyncFileDialog;

use crate::state::Ask;
use crate::task::Task;

/// Endings of the meshes that can be added.
const MESHES: [&str; 7] = ["obj", "stl", "ply", "gltf", "glb", "vtk", "vtp"];

/// A dialog that is open.
pub struct Dialog {
    /// What it asks for.
    pub ask: Ask,
    task: Task<Option<PathBuf>>,
}

impl Dialog {
    /// Opens a dialog that starts in this folder. `name` is the file that it proposes to save. `repaint` is called when there
    /// is an answer. Must be called on the thread of the window, because macOS opens dialogs there only.
    ///
    /// # Errors
    /// If the system starts no thread.
    pub fn open(
        ask: Ask,
        folder: Option<&Path>,
        name: &str,
        repaint: impl FnOnce() + Send + 'static,
    ) -> Result<Self, String> {
        listen();
        lock().clear();
        let mut dialog = AsyncFileDialog::new().set_title(ask.title());
        if let Some(folder) = folder {
            dialog = dialog.set_directory(folder);
        }
        let scenes = |dialog: AsyncFileDialog| dialog.add_filter("Scenes (.toml)", &["toml"]);
        type Answer = std::pin::Pin<Box<dyn Future<Output = Option<rfd::FileHandle>> + Send>>;
        let answer: Answer = match ask {
            Ask::Scene => Box::pin(scenes(dialog).pick_file()),
            Ask::Run => Box::pin(dialog.pick_folder()),
            Ask::SaveScene => Box::pin(scenes(dialog).set_file_name(name).save_file()),
            Ask::Body | Ask::Fluid => Box::pin(
                dialog.add_filter("Meshes (.obj, .stl, .ply, .gltf, .glb, .vtk, .vtp)", &MESHES).pick_file(),
            ),
        };
        let work = move || {
            let picked = splashdown_gpu::block_on(answer).map(|file| file.path().to_owned());
            outcome(picked, &std::mem::take(&mut *lock()))
        };
        Ok(Self { ask, task: Task::start("splashdown-dialog", work, repaint)? })
    }

    /// The answer as soon as it is there: a path, or `None` if the user cancels, or why no dialog can be opened.
    pub fn take(&self) -> Option<Result<Option<PathBuf>, String>> {
        self.task.take()
    }
}

/// Distinguishes a cancelled dialog from one that was never shown, by the errors that `rfd` has logged.
fn outcome(picked: Option<PathBuf>, errors: &[String]) -> Result<Option<PathBuf>, String> {
    // Where there are portals, `zenity` is tried last. Only its failure means that no dialog was shown.
    let has_portals = !cfg!(any(windows, target_os = "macos"));
    let was_shown = !errors.iter().any(|error| !has_portals || error.contains("zenity"));
    if picked.is_some() || was_shown {
        return Ok(picked);
    }
    let help = match has_portals {
        true => "install xdg-desktop-portal with the part for your desktop, or zenity",
        false => "restart the program",
    };
    let reasons = errors.join("; ");
    Err(format!(
        "no file dialog can be opened: {reasons}. To have dialogs, {help}. Without them, drop the file or the folder onto this \
         window, or name it on the command line: splashdown view FILE. Save scene writes beside the file of the scene"
    ))
}

/// The errors of `rfd` since the last dialog was opened. There is one dialog at a time.
static ERRORS: Mutex<Vec<String>> = Mutex::new(Vec::new());

/// A poisoned lock is still usable: every change is one call.
fn lock() -> MutexGuard<'static, Vec<String>> {
    ERRORS.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Collects the errors of `rfd` in [`ERRORS`].
struct Listener;

impl Log for Listener {
    fn enabled(&self, metadata: &Metadata<'_>) -> bool {
        metadata.level() <= LevelFilter::Error && metadata.target().starts_with("rfd")
    }

    fn log(&self, record: &Record<'_>) {
        if self.enabled(record.metadata()) {
            lock().push(record.args().to_string());
        }
    }

    fn flush(&self) {}
}

/// Installs the [`Listener`]. In a program that has its own logger, a dialog that cannot be shown is not reported.
fn listen() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        if log::set_logger(&Listener).is_ok() {
            log::set_max_level(LevelFilter::Error);
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cancelled_dialog_is_no_error() {
        let file = Some(PathBuf::from("a.toml"));
        assert_eq!(outcome(None, &[]), Ok(None));
        assert_eq!(outcome(file.clone(), &["a failure before".to_owned()]), Ok(file));
    }

    /// Opens a dialog of the system and prints its answer. Run by the test below in a process of its own, whose variables
    /// describe a system.
    #[cfg(target_os = "linux")]
    #[test]
    #[ignore = "it opens a dialog on the screen"]
    fn ask() {
        use std::io::Write;
        let (sender, answered) = std::sync::mpsc::channel();
        let dialog = Dialog::open(Ask::Scene, None, "", move || sender.send(()).unwrap()).unwrap();
        answered.recv_timeout(std::time::Duration::from_secs(60)).unwrap();
        writeln!(std::io::stdout(), "ANSWER {:?}", dialog.take().unwrap()).unwrap();
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_system_without_dialogs_is_reported_and_zenity_is_used_without_a_portal() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let answer = || {
            let mut test = std::process::Command::new(std::env::current_exe().unwrap());
            test.args(["--exact", "dialogs::tests::ask", "--ignored", "--nocapture"]);
            test.env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY").env("PATH", folder.path());
            test.env("DBUS_SESSION_BUS_ADDRESS", "unix:path=/nonexistent/bus");
            let output = test.output().unwrap();
            let text = String::from_utf8_lossy(&output.stdout).into_owned();
            let line = text.lines().find_map(|line| Some(line.split_once("ANSWER ")?.1.to_owned()));
            line.unwrap_or_else(|| panic!("{text} {}", String::from_utf8_lossy(&output.stderr)))
        };
        let missing = answer();
        assert!(missing.starts_with("Err(") && missing.contains("drop the file"), "{missing}");
        for (script, expected) in [("echo /a/b.toml", "Ok(Some(\"/a/b.toml\"))"), ("exit 1", "Ok(None)")] {
            let zenity = folder.path().join("zenity");
            std::fs::write(&zenity, format!("#!/bin/sh\n{script}\n")).unwrap();
            std::fs::set_permissions(&zenity, std::fs::Permissions::from_mode(0o755)).unwrap();
            assert_eq!(answer(), expected, "{script}");
        }
    }
}
