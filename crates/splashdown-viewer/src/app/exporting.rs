//! Exporting pictures, scenes and checkpoints.

#[cfg(target_arch = "wasm32")]
use std::sync::Arc;

use super::Viewer;
use crate::engine::{Command, Purpose};
#[cfg(target_arch = "wasm32")]
use crate::pixels;
use crate::{export, save};

impl Viewer {
    #[cfg(not(target_arch = "wasm32"))]
    pub(super) fn screenshot(&mut self, now: f64) {
        let name = format!("{}.png", self.state.scene.name);
        self.draw_full_size();
        let size = self.picture.texture_drawn().map_or([0, 0], |(_, size)| size);
        let picture = self.picture.read().ok_or_else(|| "it could not be read from the device".to_owned());
        let exported = picture.and_then(|rgba| export::picture(&name, size, rgba));
        self.report_export("the picture", exported, now);
    }

    /// On a web page the picture is read asynchronously.
    #[cfg(target_arch = "wasm32")]
    pub(super) fn screenshot(&mut self, now: f64) {
        self.draw_full_size();
        let Some((texture, size)) = self.picture.texture_drawn() else { return };
        let (gpu, name) = (Arc::clone(&self.gpu), format!("{}.png", self.state.scene.name));
        self.state.notify(format!("the picture was exported to your downloads, as {name}"), false, now);
        wasm_bindgen_futures::spawn_local(async move {
            if let Some(rgba) = pixels::read(gpu, texture, size).await {
                // The notification is already shown; the browser reports failures.
                let _ = export::picture(&name, size, rgba);
            }
        });
    }

    /// Draws the displayed picture again at full resolution, because a software driver displays a lower one while the
    /// simulation runs. The window draws its next picture in any case.
    fn draw_full_size(&mut self) {
        let Some(drawn) = self.drawn.take() else { return };
        let aspect = self.size[0] as f32 / self.size[1] as f32;
        // An error was already reported when the window drew the picture.
        let _ = self.picture.draw(self.size, &drawn.snapshot, &drawn.look, drawn.camera.camera(aspect));
    }

    pub(super) fn save_scene(&mut self, now: f64) {
        // The file goes into the folder of the original file, because mesh paths are relative to it.
        let folder = self.state.scene.source.as_deref().and_then(std::path::Path::parent);
        let name = folder.unwrap_or(std::path::Path::new("")).join(format!("{}.toml", self.state.scene.name));
        let name = name.to_string_lossy().into_owned();
        let exported =
            save::scene(&self.state.scene, &self.state.orbit).and_then(|text| export::text(&name, &text));
        self.report_file("the scene", "saved", exported, now);
    }

    /// Writes the scene into a file that the user has chosen, also in place of an existing one: the dialog has asked.
    #[cfg(not(target_arch = "wasm32"))]
    pub(super) fn save_scene_as(&mut self, mut path: std::path::PathBuf, now: f64) {
        if path.extension().is_none() {
            path.set_extension("toml");
        }
        let text = save::scene(&self.state.scene, &self.state.orbit)
            .and_then(|text| save::moved_to(&text, &self.state.scene, &path));
        let exported = text.and_then(|text| export::replace(&path, text.as_bytes()));
        if exported.is_ok() {
            self.remember(&path, None, now);
        }
        self.report_file("the scene", "saved", exported, now);
    }

    /// Requests a checkpoint from the engine.
    pub(super) fn checkpoint(&mut self, purpose: Purpose, now: f64) {
        match save::scene(&self.state.scene, &self.state.orbit) {
            Ok(text) => self.engine.send(Command::Checkpoint(text, purpose)),
            Err(reason) if purpose == Purpose::Export => {
                self.report_export("the checkpoint", Err(reason), now)
            }
            // The user did not request a backup, so its failure is not reported.
            Err(_) => {}
        }
    }

    /// Uses the backup after the device was lost: on a desktop it is written into a file, and a web page restarts from
    /// it.
    pub(super) fn save_rescue(&mut self, now: f64) {
        let Some(checkpoint) = self.rescue.take() else { return };
        #[cfg(target_arch = "wasm32")]
        {
            let _ = now;
            crate::browser::set_rescue(*checkpoint);
        }
        #[cfg(not(target_arch = "wasm32"))]
        {
            let name = format!("{}.{}", self.state.scene.name, splashdown::Checkpoint::ENDING);
            let exported = export::checkpoint(&name, &checkpoint);
            self.report_export("a checkpoint of the last seconds, for `splashdown view`,", exported, now);
        }
    }

    /// Puts the changed scene into the page's address, and the address into the clipboard.
    pub(super) fn share(&mut self, now: f64) {
        let text = save::scene(&self.state.scene, &self.state.orbit);
        #[cfg(target_arch = "wasm32")]
        match text {
            Ok(text) => {
                let address = crate::browser::share(&text);
                self.state.notify(
                    format!(
                        "the link is in the address bar and in the clipboard ({} characters)",
                        address.len()
                    ),
                    false,
                    now,
                );
            }
            Err(reason) => self.report_export("the link", Err(reason), now),
        }
        #[cfg(not(target_arch = "wasm32"))]
        {
            drop(text);
            self.state.notify("links exist on the web page only: save the scene as a file", true, now);
        }
    }

    pub(super) fn report_export(&mut self, what: &str, exported: Result<String, String>, now: f64) {
        self.report_file(what, "exported", exported, now);
    }

    fn report_file(&mut self, what: &str, done: &str, outcome: Result<String, String>, now: f64) {
        match outcome {
            Ok(path) => self.state.notify(format!("{what} was {done} to {path}"), false, now),
            Err(reason) => self.state.notify(format!("{what} was not {done}: {reason}"), true, now),
        }
    }

    #[cfg(target_arch = "wasm32")]
    pub(super) fn toggle_recording(&mut self, now: f64) {
        self.state.notify("films cannot be recorded on a web page", true, now);
    }
}
