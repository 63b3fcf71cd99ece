//! Where files of the window go: into the current folder, without writing over anything.

use std::path::{Path, PathBuf};

use splashdown_io::{Mesh, Picture, atomic, picture, ply};

/// Writes a picture; where it is.
///
/// # Errors
/// A sentence with the file's name.
pub fn png(name: &str, [width, height]: [u32; 2], rgba: Vec<u8>) -> Result<String, String> {
    let path = free(name);
    picture::write_png(&path, &Picture { width, height, rgba }).map_err(|error| error.to_string())?;
    Ok(path.display().to_string())
}

/// Writes a mesh as PLY; where it is.
///
/// # Errors
/// A sentence with the file's name.
pub fn mesh(name: &str, mesh: &Mesh) -> Result<String, String> {
    let path = free(name);
    ply::write_mesh(&path, mesh).map_err(|error| error.to_string())?;
    Ok(path.display().to_string())
}

/// Writes a text; where it is.
///
/// # Errors
/// A sentence with the file's name.
pub fn text(name: &str, text: &str) -> Result<String, String> {
    let path = free(name);
    atomic::write(&path, |out| out.write_all(text.as_bytes())).map_err(|error| error.to_string())?;
    Ok(path.display().to_string())
}

/// This name, or with the first number that no file has yet.
fn free(name: &str) -> PathBuf {
    let wanted = PathBuf::from(name);
    let stem = wanted.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let extension = wanted.extension().unwrap_or_default().to_string_lossy().into_owned();
    let numbered = (2..).map(|number| PathBuf::from(format!("{stem}-{number}.{extension}")));
    std::iter::once(wanted).chain(numbered).find(|path| !Path::new(path).exists()).unwrap_or_default()
}
