//! A picture on the host, and how to write it as PNG.

use std::io;
use std::path::Path;

use image::ImageEncoder;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};

use crate::atomic;
use crate::error::IoError;

/// An RGBA picture, 8 bits each, sRGB, straight alpha, rows from top to bottom without gaps.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Picture {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// width * height * 4 bytes.
    pub rgba: Vec<u8>,
}

impl Picture {
    /// Tells whether the bytes fit the size, and whether there is a pixel at all.
    ///
    /// # Errors
    /// [`IoError::PictureSize`].
    pub fn check(&self) -> Result<(), IoError> {
        let expected = (u64::from(self.width) * u64::from(self.height)).saturating_mul(4);
        let given = self.rgba.len() as u64;
        if given == expected && expected > 0 {
            return Ok(());
        }
        Err(IoError::PictureSize { width: self.width, height: self.height, expected, given })
    }
}

/// Reads a PNG back, whatever its colours.
///
/// # Errors
/// [`IoError::Read`]; [`IoError::Malformed`] where it is no PNG or damaged.
pub fn read_png(path: &Path) -> Result<Picture, IoError> {
    let bytes = std::fs::read(path).map_err(|error| IoError::read(path, &error))?;
    let image = image::load_from_memory_with_format(&bytes, image::ImageFormat::Png)
        .map_err(|error| IoError::malformed(path, "PNG", error.to_string()))?
        .into_rgba8();
    Ok(Picture { width: image.width(), height: image.height(), rgba: image.into_raw() })
}

/// Writes a picture to `path` as PNG, complete or not at all; returns the file's size in bytes.
///
/// The fast compression is used: a frame should not wait for its picture, and the film is made from raw pixels.
///
/// # Errors
/// [`IoError::PictureSize`] or [`IoError::Write`].
pub fn write_png(path: &Path, picture: &Picture) -> Result<u64, IoError> {
    picture.check()?;
    atomic::write(path, |out| {
        PngEncoder::new_with_quality(out, CompressionType::Fast, FilterType::Adaptive)
            .write_image(&picture.rgba, picture.width, picture.height, image::ExtendedColorType::Rgba8)
            .map_err(|error| match error {
                image::ImageError::IoError(error) => error,
                other => io::Error::other(other),
            })
    })
}
