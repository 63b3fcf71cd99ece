//! The files of an archive.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};

use super::{Release, extras, licences, man, read, target::Target};
use crate::command::root;

/// One file of an archive.
#[derive(Debug)]
pub struct StagedFile {
    /// Path inside the archive's folder, with `/`.
    pub path: String,
    pub bytes: Vec<u8>,
    pub executable: bool,
}

impl StagedFile {
    /// A file with these contents.
    pub fn new(path: impl Into<String>, bytes: impl Into<Vec<u8>>) -> Self {
        Self { path: path.into(), bytes: bytes.into(), executable: false }
    }
}

/// All files of the archive of a target.
pub fn collect(release: &Release, target: &Target, binary: &Path) -> Result<Vec<StagedFile>> {
    let name = binary.file_name().context("the binary has no name")?.to_string_lossy().into_owned();
    let mut files = vec![StagedFile { path: name, bytes: read(binary)?, executable: true }];
    files.push(StagedFile::new("README.md", read(&root().join("crates/splashdown-cli/README.md"))?));
    for name in ["CHANGELOG.md", "LICENSE-APACHE", "LICENSE-MIT"] {
        files.push(StagedFile::new(name, read(&root().join(name))?));
    }
    files.push(StagedFile::new("THIRD-PARTY.txt", licences::text(target)?));
    files.extend(scenes()?);
    if target.is_host() {
        let commands = extras::commands(binary)?;
        files.push(StagedFile::new("man/splashdown.1", man::page(binary, &commands, release)?));
        files.extend(extras::completions(binary)?);
    }
    files.sort_by(|a, b| a.path.cmp(&b.path));
    Ok(files)
}

/// The built-in scenes with their reference and schema.
fn scenes() -> Result<Vec<StagedFile>> {
    let folder = root().join("crates/splashdown/scenes");
    let entries = fs::read_dir(&folder).with_context(|| format!("cannot list {}", folder.display()))?;
    let mut files = Vec::new();
    for entry in entries {
        let path = entry?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if path.is_file() {
            files.push(StagedFile::new(format!("scenes/{name}"), read(&path)?));
        }
    }
    Ok(files)
}
