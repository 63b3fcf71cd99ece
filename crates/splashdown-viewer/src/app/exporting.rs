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
        self.draw_in_full();
        let size = self.picture.texture_drawn().map_or([0, 0], |(_, size)| size);
        let picture = self.picture.read().ok_or_else(|| "the device did not hand it out".to_owned());
        let exported = picture.and_then(|rgba| export::picture(&name, size, rgba));
        self.report_export("the picture", exported, now);
    }

    /// The page gets the picture when the browser has it.
    #[cfg(target_arch = "wasm32")]
    pub(super) fn screenshot(&mut self, now: f64) {
        self.draw_in_full();
        let Some((texture, size)) = self.picture.texture_drawn() else { return };
        let (gpu, name) = (Arc::clone(&self.gpu), format!("{}.png", self.state.scene.name));
        self.state.tell(format!("the picture is in your downloads, as {name}"), false, now);
        wasm_bindgen_futures::spawn_local(async move {
            if let Some(rgba) = pixels::read(gpu, texture, size).await {
                // It has been told already where it is; without it the browser says why.
                let _ = export::picture(&name, size, rgba);
            }
        });
    }

    /// Draws with all pixels what is shown with fewer while the water moves. The next picture of the window is
    /// drawn anew.
    fn draw_in_full(&mut self) {
        let Some(drawn) = self.drawn.take() else { return };
        let aspect = self.size[0] as f32 / self.size[1] as f32;
        // An error of this picture was told when it was drawn for the window.
        let _ = self.picture.draw(self.size, &drawn.snapshot, &drawn.look, drawn.camera.camera(aspect));
    }

    pub(super) fn save_scene(&mut self, now: f64) {
        // Beside the file that it came from: its meshes are named from there.
        let folder = self.state.scene.source.as_deref().and_then(std::path::Path::parent);
        let name = folder.unwrap_or(std::path::Path::new("")).join(format!("{}.toml", self.state.scene.name));
        let name = name.to_string_lossy().into_owned();
        let exported =
            save::scene(&self.state.scene, &self.state.orbit).and_then(|text| export::text(&name, &text));
        self.report_export("the scene", exported, now);
    }

    /// Asks the engine for a checkpoint.
    pub(super) fn checkpoint(&mut self, purpose: Purpose, now: f64) {
        match save::scene(&self.state.scene, &self.state.orbit) {
            Ok(text) => self.engine.send(Command::Checkpoint(text, purpose)),
            Err(reason) if purpose == Purpose::Keep => self.report_export("the checkpoint", Err(reason), now),
            // Nobody has asked for it.
            Err(_) => {}
        }
    }

    /// The device is gone: on a desktop the fluid goes into a file, and a page starts itself again with it.
    pub(super) fn save_what_can_be_saved(&mut self, now: f64) {
        let Some(checkpoint) = self.rescue.take() else { return };
        #[cfg(target_arch = "wasm32")]
        {
            let _ = now;
            crate::page::set_rescue(*checkpoint);
        }
        #[cfg(not(target_arch = "wasm32"))]
        {
            let name = format!("{}.{}", self.state.scene.name, splashdown::Checkpoint::ENDING);
            let exported = export::checkpoint(&name, &checkpoint);
            self.report_export("the fluid as it was some seconds ago, for `splashdown view`,", exported, now);
        }
    }

    /// Puts the scene as it is now into the page's address, and the address into the clipboard.
    pub(super) fn share(&mut self, now: f64) {
        let text = save::scene(&self.state.scene, &self.state.orbit);
        #[cfg(target_arch = "wasm32")]
        match text {
            Ok(text) => {
                let address = crate::page::share(&text);
                self.state.tell(
                    format!(
                        "the link is in the address line and in the clipboard ({} letters)",
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
            self.state.tell("a window has no address: keep the scene as a file", true, now);
        }
    }

    pub(super) fn report_export(&mut self, what: &str, exported: Result<String, String>, now: f64) {
        match exported {
            Ok(place) => self.state.tell(format!("{what} is in {place}"), false, now),
            Err(reason) => self.state.tell(format!("{what} was not written: {reason}"), true, now),
        }
    }

    #[cfg(target_arch = "wasm32")]
    pub(super) fn record_or_end(&mut self, now: f64) {
        self.state.tell("a page records no films", true, now);
    }
}
