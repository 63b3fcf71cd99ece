//! Pictures as PNG.

use std::io::{self, Cursor, Write};
use std::path::Path;

use png::{BitDepth, ColorType, Compression, Decoder, DecodingError, Encoder, Filter, Transformations};

use super::Picture;
use crate::atomic;
use crate::error::IoError;
use crate::input::content;
use crate::limit::Budget;

/// Reads a PNG file of any colour type and depth.
///
/// # Errors
/// [`IoError::Read`]; [`IoError::Malformed`] if it is not a PNG file or damaged.
pub fn read_png(path: &Path) -> Result<Picture, IoError> {
    let bytes = content(path)?;
    decode_png(&bytes).map_err(|error| IoError::malformed(path, "PNG", error.to_string()))
}

/// Reads the bytes of a PNG file of any colour type and depth. 16-bit channels lose their lower 8 bits.
///
/// # Errors
/// Of kind [`InvalidData`](io::ErrorKind::InvalidData) if it is not a PNG file or damaged.
pub fn decode_png(bytes: &[u8]) -> io::Result<Picture> {
    let wrong = |error: DecodingError| io::Error::new(io::ErrorKind::InvalidData, error.to_string());
    let mut decoder = Decoder::new(Cursor::new(bytes));
    decoder.set_transformations(Transformations::normalize_to_color8() | Transformations::ALPHA);
    let mut reader = decoder.read_info().map_err(wrong)?;
    let size = reader.output_buffer_size().ok_or(io::ErrorKind::OutOfMemory)?;
    let mut budget = Budget::of_file(bytes.len() as u64);
    budget
        .take(size as u64, "the picture")
        .map_err(|error| io::Error::new(io::ErrorKind::InvalidData, error))?;
    let mut pixels = vec![0; size];
    let info = reader.next_frame(&mut pixels).map_err(wrong)?;
    let rgba = match info.color_type {
        ColorType::Rgba => pixels,
        ColorType::GrayscaleAlpha => pixels.as_chunks().0.iter().flat_map(|&[l, a]| [l, l, l, a]).collect(),
        other => {
            return Err(io::Error::other(format!("its pixels were decoded to {other:?} instead of RGBA")));
        }
    };
    Ok(Picture { width: info.width, height: info.height, rgba })
}

/// Writes a picture to `path` as PNG. The file is complete or absent. Returns its size in bytes.
///
/// It uses fast compression, so that a frame does not wait for its picture; films are made from raw pixels.
///
/// # Errors
/// [`IoError::PictureSize`] or [`IoError::Write`].
pub fn write_png(path: &Path, picture: &Picture) -> Result<u64, IoError> {
    picture.check()?;
    atomic::write(path, |out| encode(out, picture))
}

/// Writes a picture as PNG to `out`.
///
/// # Errors
/// Of kind [`InvalidInput`](io::ErrorKind::InvalidInput) if the bytes do not match the size; those of `out`.
pub fn write_png_to(out: &mut dyn Write, picture: &Picture) -> io::Result<()> {
    picture.check()?;
    encode(out, picture)
}

fn encode(out: &mut dyn Write, picture: &Picture) -> io::Result<()> {
    let mut encoder = Encoder::new(out, picture.width, picture.height);
    encoder.set_color(ColorType::Rgba);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(Compression::Fast);
    encoder.set_filter(Filter::Adaptive);
    let mut writer = encoder.write_header()?;
    Ok(writer.write_image_data(&picture.rgba)?)
}
