//! What a desktop has and a web page has not: dialogs, large files that are read in the background, and a list of recent
//! files.

use std::collections::VecDeque;
use std::path::{Path, PathBuf};

use egui::Context;
use glam::Vec3;
use splashdown::scene::Scene;

use super::Viewer;
use crate::dialogs::Dialog;
use crate::opening::{self, Contents, Resumable};
use crate::recent::RecentFiles;
use crate::state::{Ask, RecentFile};
use crate::task::Task;
use crate::{edit, panels};

/// Number of recent checkpoints that the gallery lists.
const MENU_FILES: usize = 8;

/// Why a file is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Purpose {
    /// To show what it contains. A mesh is added as a body.
    Open,
    /// To add a mesh as a body.
    Body,
    /// To fill a mesh with fluid.
    Fluid,
    /// To continue the run that is played.
    Continue,
}

/// A file to read.
#[derive(Clone, Debug)]
struct Wanted {
    path: PathBuf,
    /// The scene of a run that does not name it.
    scene: Option<PathBuf>,
    purpose: Purpose,
}

impl Wanted {
    fn new(path: impl Into<PathBuf>, purpose: Purpose) -> Self {
        Self { path: path.into(), scene: None, purpose }
    }
}

/// The recent checkpoints, and the recent scenes and runs.
type Listing = (Vec<PathBuf>, Result<Vec<RecentFile>, String>);

/// Files that are read, one after the other, and what else happens outside the window.
pub(super) struct Desktop {
    recent: RecentFiles,
    dialog: Option<Dialog>,
    waiting: VecDeque<Wanted>,
    reading: Option<(Task<Contents>, Wanted)>,
    listing: Option<Task<Listing>>,
}

impl Desktop {
    pub fn new() -> Self {
        let recent = RecentFiles::of_user();
        Self { recent, dialog: None, waiting: VecDeque::new(), reading: None, listing: None }
    }

    /// Reads a file after those that wait. What replaces the scene also replaces what was to be read.
    fn want(&mut self, wanted: Wanted) {
        let is_mesh = opening::is_mesh(&wanted.path);
        if wanted.purpose == Purpose::Continue || (wanted.purpose == Purpose::Open && !is_mesh) {
            self.waiting.clear();
            self.reading = None;
        }
        self.waiting.push_back(wanted);
    }

    /// Starts to read the next file if none is being read; `read` runs on another thread. Returns what was read.
    fn update(
        &mut self,
        read: fn(&Wanted) -> Result<Contents, String>,
        repaint: impl FnOnce() + Send + 'static,
    ) -> Option<(Result<Contents, String>, Wanted)> {
        if let Some((task, wanted)) = self.reading.take() {
            match task.take() {
                Some(contents) => {
                    // The next file is read after the next picture.
                    repaint();
                    return Some((contents, wanted));
                }
                None => self.reading = Some((task, wanted)),
            }
            return None;
        }
        let wanted = self.waiting.pop_front()?;
        let its = wanted.clone();
        match Task::start("splashdown-open", move || read(&its), repaint) {
            Ok(task) => self.reading = Some((task, wanted)),
            Err(reason) => return Some((Err(reason), wanted)),
        }
        None
    }

    /// The name of the file that is being read.
    fn reading(&self) -> Option<String> {
        let path = self.reading.as_ref().map(|(_, wanted)| &wanted.path)?;
        Some(path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned())
    }
}

fn read(wanted: &Wanted) -> Result<Contents, String> {
    let path = &wanted.path;
    match wanted.purpose {
        Purpose::Open => opening::read(path, wanted.scene.as_deref()),
        Purpose::Body | Purpose::Fluid => opening::mesh(path),
        Purpose::Continue => opening::newest_checkpoint(path),
    }
}

impl Viewer {
    /// Starts to read a file; what it contains is used when it has been read.
    pub(super) fn want_file(&mut self, path: &Path, purpose: Purpose) {
        self.desktop.want(Wanted::new(path, purpose));
    }

    /// Starts to read a recent file. `scene` is that of a run that does not name it.
    pub(super) fn want_recent(&mut self, path: PathBuf, scene: Option<PathBuf>) {
        self.desktop.want(Wanted { path, scene, purpose: Purpose::Open });
    }

    /// Uses what has been read, chosen and listed since the last picture.
    pub(super) fn update_desktop(&mut self, ctx: &Context) {
        let now = ctx.input(|input| input.time);
        if let Some(answer) = self.desktop.dialog.as_ref().and_then(Dialog::take)
            && let Some(dialog) = self.desktop.dialog.take()
        {
            match (answer, dialog.ask) {
                (Ok(None), _) => {}
                (Ok(Some(path)), Ask::SaveScene) => self.save_scene_as(path, now),
                (Ok(Some(path)), Ask::Scene | Ask::Run) => self.want_file(&path, Purpose::Open),
                (Ok(Some(path)), Ask::Body) => self.want_file(&path, Purpose::Body),
                (Ok(Some(path)), Ask::Fluid) => self.want_file(&path, Purpose::Fluid),
                (Err(reason), _) => self.state.notify(reason, true, now),
            }
        }
        if let Some(Ok((files, recent))) = self.desktop.listing.as_ref().and_then(Task::take) {
            self.desktop.listing = None;
            self.state.files = files;
            self.state.recent = recent.unwrap_or_else(|note| {
                self.state.notify(note, false, now);
                Vec::new()
            });
        }
        let repaint = ctx.clone();
        if let Some((contents, wanted)) = self.desktop.update(read, move || repaint.request_repaint()) {
            let Wanted { path, scene, purpose } = wanted;
            let used = contents.and_then(|contents| self.use_contents(contents, purpose, ctx));
            match used {
                Ok(()) if purpose == Purpose::Open && !opening::is_mesh(&path) => {
                    self.remember(&path, scene.as_deref(), now);
                }
                Ok(()) => {}
                Err(reason) if purpose == Purpose::Continue => {
                    self.state.notify(format!("the run cannot be continued: {reason}"), true, now);
                }
                Err(reason) => self.state.notify(reason, true, now),
            }
        }
        self.state.reading = self.desktop.reading();
    }

    fn use_contents(&mut self, contents: Contents, purpose: Purpose, ctx: &Context) -> Result<(), String> {
        let now = ctx.input(|input| input.time);
        match contents {
            Contents::Scene(scene) => self.open(*scene),
            Contents::Run(run) => self.play(*run, ctx)?,
            Contents::Checkpoint(resumable) => {
                let Resumable { checkpoint, scene, skipped } = *resumable;
                self.resume_with(checkpoint, scene);
                if !skipped.is_empty() {
                    let newer = skipped.join("; ");
                    let text = format!("an older checkpoint is used, because newer ones cannot be: {newer}");
                    self.state.notify(text, true, now);
                }
            }
            Contents::Mesh(..) if self.state.timeline.is_some() => {
                let text = "a run that is played cannot be changed. Continue it, or open a scene first";
                return Err(text.to_owned());
            }
            Contents::Mesh(path, bounds) => self.add_mesh(path, bounds, purpose, ctx),
        }
        Ok(())
    }

    fn add_mesh(&mut self, path: PathBuf, bounds: [Vec3; 2], purpose: Purpose, ctx: &Context) {
        let (now, mut actions) = (ctx.input(|input| input.time), Vec::new());
        let add = |scene: &mut Scene| match purpose {
            Purpose::Fluid => edit::add_fluid_mesh(scene, path, bounds),
            _ => edit::add_mesh(scene, path, bounds),
        };
        // Fluid is added at time 0, as everything is with the tool Edit.
        match purpose {
            Purpose::Fluid => panels::change_at_start(&mut self.state, &mut actions, now, add),
            _ => panels::change_things(&mut self.state, &mut actions, now, add),
        }
        actions.into_iter().for_each(|action| self.act(action, ctx));
    }

    /// Opens a dialog of the desktop, unless one is open.
    pub(super) fn ask(&mut self, ask: Ask, ctx: &Context) {
        let now = ctx.input(|input| input.time);
        if self.desktop.dialog.is_some() {
            self.state.notify("a file dialog is open already", false, now);
            return;
        }
        let source = self.state.scene.source.as_deref().and_then(Path::parent);
        // The folder of a scene named without one is the current folder.
        let folder = source.and_then(|folder| std::path::absolute(folder).ok());
        let folder = folder.or_else(|| std::env::current_dir().ok());
        let name = format!("{}.toml", self.state.scene.name);
        let repaint = ctx.clone();
        match Dialog::open(ask, folder.as_deref(), &name, move || repaint.request_repaint()) {
            Ok(dialog) => self.desktop.dialog = Some(dialog),
            Err(reason) => self.state.notify(reason, true, now),
        }
    }

    /// Lists recent checkpoints, scenes and runs. Their folders may be on a slow disk.
    pub(super) fn list_files(&mut self, ctx: &Context) {
        let (recent, repaint) = (self.desktop.recent.clone(), ctx.clone());
        let list = move || Ok((splashdown_run::recent_checkpoints(MENU_FILES), recent.list()));
        // Without a thread the gallery shows the last list.
        self.desktop.listing = Task::start("splashdown-files", list, move || repaint.request_repaint()).ok();
    }

    /// Puts a file in front of the recent ones, with the scene of a run that does not name it.
    pub(crate) fn remember(&mut self, path: &Path, scene: Option<&Path>, now: f64) {
        if let Err(note) = self.desktop.recent.add(path, scene) {
            self.state.notify(note, false, now);
        }
    }

    /// Clears the list of recent files.
    pub(super) fn forget_recent(&mut self, ctx: &Context) {
        if let Err(note) = self.desktop.recent.clear() {
            self.state.notify(note, true, ctx.input(|input| input.time));
        }
        self.list_files(ctx);
    }

    /// Continues the simulation of the run that is played from its newest checkpoint.
    pub(super) fn continue_run(&mut self) {
        if let Some(folder) = self.played_folder() {
            self.want_file(&folder, Purpose::Continue);
        }
    }

    /// Opens dropped files.
    pub(super) fn dropped_files(&mut self, ctx: &Context) {
        for file in ctx.input(|input| input.raw.dropped_files.clone()) {
            self.want_file(file.path(), Purpose::Open);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Mutex;
    use std::time::{Duration, Instant};

    use super::*;

    /// Held while the "disk" is slow.
    static DISK: Mutex<()> = Mutex::new(());

    fn slow(wanted: &Wanted) -> Result<Contents, String> {
        drop(DISK.lock());
        Err(wanted.path.display().to_string())
    }

    /// The names that are read until nothing remains.
    fn rest(desktop: &mut Desktop) -> Vec<String> {
        let (begun, mut names) = (Instant::now(), Vec::new());
        while desktop.reading.is_some() || !desktop.waiting.is_empty() {
            names.extend(desktop.update(slow, || {}).and_then(|(read, ..)| read.err()));
            assert!(begun.elapsed() < Duration::from_secs(30), "{names:?}");
        }
        names
    }

    #[test]
    fn the_window_does_not_wait_for_a_slow_file() {
        let mut desktop = Desktop::new();
        let busy = DISK.lock().unwrap();
        desktop.want(Wanted::new("run", Purpose::Open));
        // If the file were read here, this call would never return.
        assert!(desktop.update(slow, || {}).is_none() && desktop.update(slow, || {}).is_none());
        assert_eq!(desktop.reading(), Some("run".to_owned()));
        // Meshes wait for it; another scene replaces all of them.
        desktop.want(Wanted::new("a.obj", Purpose::Open));
        desktop.want(Wanted::new("b.toml", Purpose::Open));
        desktop.want(Wanted::new("c.obj", Purpose::Open));
        desktop.want(Wanted::new("d.stl", Purpose::Fluid));
        drop(busy);
        assert_eq!(rest(&mut desktop), ["b.toml", "c.obj", "d.stl"]);
        assert_eq!(desktop.reading(), None);
    }
}
