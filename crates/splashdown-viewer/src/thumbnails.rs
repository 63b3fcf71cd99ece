//! Thumbnails of the built-in scenes.

use egui::{ColorImage, Context, Id, TextureHandle, TextureId};
use splashdown::scene::presets;
use splashdown_io::picture::decode_png;

/// Width of a thumbnail, in points.
pub const WIDTH: f32 = 144.0;

/// Names and descriptions of the scenes.
pub fn scenes() -> impl Iterator<Item = (&'static str, String)> {
    presets().iter().map(|(name, text)| (*name, about(text)))
}

/// The comment at the start of a scene file.
fn about(text: &str) -> String {
    let lines = text.lines().take_while(|line| line.starts_with('#'));
    lines.map(|line| line.trim_start_matches('#').trim()).collect::<Vec<_>>().join(" ")
}

/// The thumbnail, uploaded once; `None` for a scene that has none.
pub fn texture(ctx: &Context, name: &str) -> Option<TextureId> {
    let id = Id::unique(("thumbnail", name));
    if let Some(handle) = ctx.data(|data| data.get_temp::<TextureHandle>(id)) {
        return Some(handle.id());
    }
    let (_, png) = PICTURES.iter().find(|(scene, _)| *scene == name)?;
    let picture = decode_png(png).ok()?;
    let size = [picture.width as usize, picture.height as usize];
    let image = ColorImage::from_rgba_unmultiplied(size, &picture.rgba);
    let handle = ctx.load_texture(name, image, egui::TextureOptions::LINEAR);
    let texture = handle.id();
    ctx.data_mut(|data| data.insert_temp(id, handle));
    Some(texture)
}

macro_rules! pictures {
    ($($name:literal),+ $(,)?) => {
        &[$(($name, include_bytes!(concat!("../thumbnails/", $name, ".png")))),+]
    };
}

/// PNG files of 192 x 108, made from the pictures of the README by `cargo xtask pictures`.
const PICTURES: &[(&str, &[u8])] = pictures![
    "boat",
    "cup",
    "dam-break",
    "dam-break-small",
    "double-dam-break",
    "drum",
    "falling-drop",
    "floating",
    "honey",
    "honey-coil",
    "knot",
    "lighthouse",
    "paddle-wheel",
    "sloshing-tank",
    "spheric2",
    "thesis-16k",
    "thesis-32k",
    "thesis-64k",
    "thesis-8k",
    "thin-cup",
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_scene_has_a_thumbnail() {
        for (name, _) in scenes() {
            let (_, png) =
                PICTURES.iter().find(|(scene, _)| *scene == name).unwrap_or_else(|| panic!("{name}"));
            let picture = decode_png(png).unwrap_or_else(|error| panic!("{name}: {error}"));
            assert_eq!((picture.width, picture.height), (192, 108), "{name}");
        }
    }
}
