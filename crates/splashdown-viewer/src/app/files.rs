//! Opening files: scenes, checkpoints and meshes, dropped or selected.

use std::path::Path;

use egui::Context;
#[cfg(not(target_arch = "wasm32"))]
use glam::Vec3;
use splashdown::Checkpoint;
use splashdown::error::CheckpointError;
use splashdown::scene::Scene;

use super::Viewer;
#[cfg(not(target_arch = "wasm32"))]
use crate::edit;
use crate::engine::Command;

impl Viewer {
    /// Opens dropped files.
    #[cfg(not(target_arch = "wasm32"))]
    pub(super) fn dropped_files(&mut self, ctx: &Context) {
        let now = ctx.input(|input| input.time);
        for file in ctx.input(|input| input.raw.dropped_files.clone()) {
            match file.path().is_dir() {
                true => self.open_folder(file.path(), ctx),
                false => self.open_file(file.path(), now),
            }
        }
    }

    /// Opens dropped files, which the browser reads asynchronously.
    #[cfg(target_arch = "wasm32")]
    pub(super) fn dropped_files(&mut self, ctx: &Context) {
        let now = ctx.input(|input| input.time);
        for file in ctx.input(|input| input.raw.dropped_files.clone()) {
            let ctx = ctx.clone();
            wasm_bindgen_futures::spawn_local(async move {
                let read = file.bytes_async().await;
                crate::browser::arrived(file.path().to_owned(), read);
                ctx.request_repaint();
            });
        }
        for (path, read) in crate::browser::take_arrived() {
            match read {
                Ok(bytes) => self.open_bytes(&path, &bytes, now),
                Err(reason) => self.state.notify(format!("{}: {reason}", path.display()), true, now),
            }
        }
    }

    /// Opens a file according to its ending.
    #[cfg(not(target_arch = "wasm32"))]
    pub(super) fn open_file(&mut self, path: &Path, now: f64) {
        match ending(path).as_str() {
            "toml" | Checkpoint::ENDING => match std::fs::read(path) {
                Ok(bytes) => self.open_bytes(path, &bytes, now),
                Err(error) => self.state.notify(format!("{}: {error}", path.display()), true, now),
            },
            _ if self.state.timeline.is_some() => {
                let text = "a run that is played cannot be changed; continue it, or open a scene first";
                self.state.notify(text, true, now);
            }
            _ => match splashdown_io::read_mesh(path) {
                Ok(mesh) => {
                    let corners = mesh.vertices.iter().map(|&v| Vec3::from(v));
                    let low = corners.clone().fold(Vec3::INFINITY, Vec3::min);
                    let high = corners.fold(Vec3::NEG_INFINITY, Vec3::max);
                    edit::add_mesh(&mut self.state.scene, path.to_owned(), low, high);
                    self.change();
                }
                Err(error) => self.state.notify(error.to_string(), true, now),
            },
        }
    }

    fn open_bytes(&mut self, path: &Path, bytes: &[u8], now: f64) {
        let opened = match ending(path).as_str() {
            "toml" => open_scene(path, bytes).map(|scene| self.open(scene)),
            Checkpoint::ENDING => {
                let checkpoint = Checkpoint::from_bytes(bytes).map_err(|error| error.to_string());
                checkpoint.and_then(|checkpoint| {
                    // An unusable checkpoint does not replace the running simulation.
                    let resumed = checkpoint.check().and_then(|()| self.resume(checkpoint));
                    resumed.map_err(|error| error.to_string())
                })
            }
            _ => Err(format!(
                "the web page opens scenes (.toml) and checkpoints (.{}); `splashdown view` also opens meshes",
                Checkpoint::ENDING
            )),
        };
        if let Err(reason) = opened {
            self.state.notify(format!("{}: {reason}", path.display()), true, now);
        }
    }

    /// Resumes from a checked checkpoint, at its time.
    pub(crate) fn resume(&mut self, checkpoint: Checkpoint) -> Result<(), CheckpointError> {
        let scene = checkpoint.scene()?;
        self.leave_playback();
        self.state.open(scene);
        self.engine.send(Command::MouseForce(None));
        self.engine.send(Command::Resume(Box::new(checkpoint)));
        self.engine.send(Command::TimeScale(self.state.time_scale.into()));
        self.engine.send(Command::Play(self.state.playing));
        Ok(())
    }
}

fn ending(path: &Path) -> String {
    path.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase()).unwrap_or_default()
}

/// Reads a scene file. On a web page only the name of a file is known, not its folder.
fn open_scene(path: &Path, bytes: &[u8]) -> Result<Scene, String> {
    let text = std::str::from_utf8(bytes).map_err(|error| format!("it is not text: {error}"))?;
    let scene = match cfg!(target_arch = "wasm32") {
        true => Scene::parse(text, &path.display().to_string()),
        false => Scene::parse_beside(text, path),
    };
    scene.map_err(|error| error.to_string())
}
