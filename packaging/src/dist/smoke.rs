//! Tests an archive: unpacks it into an empty folder and runs the program there.

use std::fs::{self, File};
use std::path::Path;

use anyhow::{Context, Result, ensure};
use flate2::read::GzDecoder;

use crate::command::{program, run as execute, say};

/// Unpacks an archive, simulates one frame of a small scene on the CPU, and removes the folder.
///
/// # Errors
/// If the program fails or writes no particles.
pub fn run(archive: &Path, name: &str) -> Result<()> {
    let folder = archive.with_file_name(format!("{name}.check"));
    if folder.exists() {
        fs::remove_dir_all(&folder)?;
    }
    fs::create_dir_all(&folder)?;
    unpack(archive, &folder)?;
    let place = folder.join(name);
    let binary = place.join(format!("splashdown{}", std::env::consts::EXE_SUFFIX));
    say(format!("Testing {} ...", binary.display()));
    let mut command = program(&binary, &place, ["run", "scenes/dam-break-small.toml", "--frames", "1"]);
    command.args(["--device", "cpu", "--no-pictures", "--quiet", "--out", "out"]);
    execute(&mut command)?;
    let frame = place.join("out/particles/particles_0001.ply");
    ensure!(frame.exists(), "the program succeeded, but {} does not exist", frame.display());
    fs::remove_dir_all(&folder).with_context(|| format!("cannot remove {}", folder.display()))
}

fn unpack(archive: &Path, folder: &Path) -> Result<()> {
    let file = File::open(archive)?;
    if archive.extension().is_some_and(|extension| extension == "zip") {
        zip::ZipArchive::new(file)?.extract(folder)?;
    } else {
        tar::Archive::new(GzDecoder::new(file)).unpack(folder)?;
    }
    Ok(())
}
