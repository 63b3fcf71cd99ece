//! Archives: `.tar.gz`, and `.zip` for Windows.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use flate2::{Compression, GzBuilder};
use zip::write::SimpleFileOptions;

use super::stage::StagedFile;

/// Writes the files into a folder with the name of the archive, and returns the path of the archive.
pub fn write(folder: &Path, name: &str, files: &[StagedFile], time: u64, zip: bool) -> Result<PathBuf> {
    let path = folder.join(format!("{name}.{}", if zip { "zip" } else { "tar.gz" }));
    let partial = folder.join(format!("{name}.partial"));
    let file = File::create(&partial).with_context(|| format!("cannot create {}", partial.display()))?;
    let entries = files.iter().map(|file| (format!("{name}/{}", file.path), file));
    if zip {
        write_zip(file, entries)?
    } else {
        write_gzipped_tar(BufWriter::new(file), entries, time)?
    }
    fs::rename(&partial, &path)?;
    Ok(path)
}

/// A gzipped tar archive of files and their folders. Owner and group are root, as in a Debian package.
pub fn write_gzipped_tar<'a>(
    file: impl Write,
    entries: impl Iterator<Item = (String, &'a StagedFile)>,
    time: u64,
) -> Result<()> {
    let gzip = GzBuilder::new().mtime(0).write(file, Compression::best());
    let mut tar = tar::Builder::new(gzip);
    let mut folders = std::collections::BTreeSet::new();
    for (path, file) in entries {
        let above: Vec<&Path> = Path::new(&path).ancestors().skip(1).collect();
        for folder in above.into_iter().rev().filter(|folder| !folder.as_os_str().is_empty()) {
            if folder != Path::new(".") && folders.insert(folder.to_owned()) {
                append(
                    &mut tar,
                    &format!("{}/", folder.display()),
                    &[],
                    0o755,
                    time,
                    tar::EntryType::Directory,
                )?;
            }
        }
        let mode = if file.executable { 0o755 } else { 0o644 };
        append(&mut tar, &path, &file.bytes, mode, time, tar::EntryType::Regular)?;
    }
    tar.into_inner()?.finish()?.flush()?;
    Ok(())
}

fn append(
    tar: &mut tar::Builder<impl Write>,
    path: &str,
    bytes: &[u8],
    mode: u32,
    time: u64,
    kind: tar::EntryType,
) -> io::Result<()> {
    let mut header = tar::Header::new_gnu();
    header.set_entry_type(kind);
    header.set_mode(mode);
    header.set_mtime(time);
    header.set_size(bytes.len() as u64);
    header.set_uid(0);
    header.set_gid(0);
    header.set_username("root")?;
    header.set_groupname("root")?;
    tar.append_data(&mut header, path, bytes)
}

fn write_zip<'a>(file: File, entries: impl Iterator<Item = (String, &'a StagedFile)>) -> Result<()> {
    let mut zip = zip::ZipWriter::new(file);
    for (path, file) in entries {
        let mode = if file.executable { 0o755 } else { 0o644 };
        zip.start_file(path, SimpleFileOptions::default().unix_permissions(mode))?;
        zip.write_all(&file.bytes)?;
    }
    zip.finish()?.sync_all()?;
    Ok(())
}
