//! Opening what has been read: scenes and checkpoints. A web page also reads the dropped files here.

#[cfg(target_arch = "wasm32")]
use std::path::Path;

#[cfg(target_arch = "wasm32")]
use egui::Context;
use splashdown::Checkpoint;
use splashdown::error::CheckpointError;
use splashdown::scene::Scene;

use super::Viewer;
use crate::engine::Command;

impl Viewer {
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

    #[cfg(target_arch = "wasm32")]
    fn open_bytes(&mut self, path: &Path, bytes: &[u8], now: f64) {
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase());
        let opened = match ending.unwrap_or_default().as_str() {
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
        self.resume_with(checkpoint, scene);
        Ok(())
    }

    /// As [`resume`](Self::resume), with the scene of the checkpoint.
    pub(super) fn resume_with(&mut self, checkpoint: Checkpoint, scene: Scene) {
        self.leave_playback();
        self.state.open(scene);
        self.engine.send(Command::MouseForce(None));
        self.engine.send(Command::Resume(Box::new(checkpoint)));
        self.engine.send(Command::TimeScale(self.state.time_scale.into()));
        self.engine.send(Command::Play(self.state.playing));
    }
}

/// Reads a scene file. On a web page only the name of a file is known, not its folder.
#[cfg(target_arch = "wasm32")]
fn open_scene(path: &Path, bytes: &[u8]) -> Result<Scene, String> {
    let text = std::str::from_utf8(bytes).map_err(|error| format!("it is not text: {error}"))?;
    Scene::parse(text, &path.display().to_string()).map_err(|errors| crate::problem::of_scene(&errors))
}
