//! Keeping pictures, scenes and films.

#[cfg(target_arch = "wasm32")]
use std::sync::Arc;

use super::Viewer;
#[cfg(target_arch = "wasm32")]
use crate::pixels;
use crate::{keep, save};

impl Viewer {
    #[cfg(not(target_arch = "wasm32"))]
    pub(super) fn screenshot(&mut self, now: f64) {
        let name = format!("{}.png", self.state.scene.name);
        self.draw_in_full();
        let size = self.picture.texture_drawn().map_or([0, 0], |(_, size)| size);
        let picture = self.picture.read().ok_or_else(|| "the device did not hand it out".to_owned());
        let kept = picture.and_then(|rgba| keep::png(&name, size, rgba));
        self.tell_kept("the picture", kept, now);
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
                let _ = keep::png(&name, size, rgba);
            }
        });
    }

    /// Draws with all pixels what is shown with fewer while the water moves. The next picture of the window is drawn anew.
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
        let kept = save::scene(&self.text, &self.state.scene, &self.state.orbit)
            .and_then(|text| keep::text(&name, &text));
        self.tell_kept("the scene", kept, now);
    }

    pub(super) fn tell_kept(&mut self, what: &str, kept: Result<String, String>, now: f64) {
        match kept {
            Ok(place) => self.state.tell(format!("{what} is in {place}"), false, now),
            Err(reason) => self.state.tell(format!("{what} was not written: {reason}"), true, now),
        }
    }

    #[cfg(target_arch = "wasm32")]
    pub(super) fn record_or_end(&mut self, now: f64) {
        self.state.tell("a page records no films", true, now);
    }
}
