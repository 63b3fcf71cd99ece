//! Single files exported on request, as from the window. Nothing is overwritten.

use std::path::{Path, PathBuf};

use splashdown_io::{IoError, Mesh, Picture, atomic, picture, ply};

/// This file name, or the first numbered one that is not in use: `scene.ply`, `scene-2.ply`, ...
pub fn unused_file(path: &Path) -> PathBuf {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let ending = path.extension().map(|ending| format!(".{}", ending.to_string_lossy())).unwrap_or_default();
    unused(path, |number| format!("{stem}-{number}{ending}"))
}

/// This folder name, or the first numbered one that is not in use: `film`, `film-2`, ...
pub fn unused_folder(path: &Path) -> PathBuf {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    unused(path, |number| format!("{name}-{number}"))
}

fn unused(path: &Path, name: impl Fn(u64) -> String) -> PathBuf {
    let numbered = (2..).map(|number| path.with_file_name(name(number)));
    std::iter::once(path.to_owned()).chain(numbered).find(|path| !path.exists()).unwrap_or_default()
}

/// Writes a file under an [unused name](unused_file), which is returned.
///
/// # Errors
/// [`IoError::Write`].
pub fn write(path: &Path, bytes: &[u8]) -> Result<PathBuf, IoError> {
    let path = unused_file(path);
    atomic::write(&path, |out| out.write_all(bytes))?;
    Ok(path)
}

/// A picture as the bytes of a PNG file.
///
/// # Errors
/// [`IoError::PictureSize`].
pub fn png(picture: &Picture) -> Result<Vec<u8>, IoError> {
    picture.check()?;
    let mut bytes = Vec::new();
    match picture::write_png_to(&mut bytes, picture) {
        Ok(()) => Ok(bytes),
        Err(error) => unreachable!("writing a valid picture into memory: {error}"),
    }
}

/// A mesh as the bytes of a PLY file.
///
/// # Errors
/// As [`Mesh::check`].
pub fn ply(mesh: &Mesh) -> Result<Vec<u8>, IoError> {
    mesh.check()?;
    let mut bytes = Vec::new();
    match ply::write_mesh_to(&mut bytes, mesh) {
        Ok(()) => Ok(bytes),
        Err(error) => unreachable!("writing a valid mesh into memory: {error}"),
    }
}

#[cfg(test)]
mod tests {
    use super::{unused_folder, write};
    use std::fs;

    #[test]
    fn names_in_use_get_a_number() -> Result<(), Box<dyn std::error::Error>> {
        let folder = tempfile::tempdir()?;
        for expected in ["a.b.ply", "a.b-2.ply", "a.b-3.ply"] {
            assert_eq!(write(&folder.path().join("a.b.ply"), b"x")?, folder.path().join(expected));
        }
        fs::create_dir(folder.path().join("v1.2"))?;
        assert_eq!(unused_folder(&folder.path().join("v1.2")), folder.path().join("v1.2-2"));
        Ok(())
    }
}
