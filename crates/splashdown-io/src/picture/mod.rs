//! A picture in host memory. With the feature `png` it is read from and written to PNG files.

use crate::error::IoError;

#[cfg(feature = "png")]
pub use png_file::{decode_png, read_png, write_png, write_png_to};

#[cfg(feature = "png")]
mod png_file;

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
    /// Checks that the number of bytes matches the size, and that there is a pixel.
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
