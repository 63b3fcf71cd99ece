//! The scenes and runs that were opened last, in a small file of the user.
//!
//! The list is a convenience: a file that is missing, damaged or cannot be written never prevents anything else.

use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};

use toml_edit::{Array, DocumentMut, value};

use crate::state::RecentFile;

/// Number of entries.
const LIMIT: usize = 10;
/// Size of the largest file that is read, in bytes. Ten paths are shorter.
const MAX_BYTES: u64 = 64 << 10;
/// The key in the file.
const KEY: &str = "recent";

/// The list in a file.
#[derive(Clone, Debug)]
pub struct RecentFiles {
    /// `None`: the system has no folder for it, and nothing is remembered.
    file: Option<PathBuf>,
}

impl RecentFiles {
    /// The list of the user: `splashdown/recent.toml` in the folder of the system for the state of programs.
    pub fn of_user() -> Self {
        let from = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
        let home = if cfg!(target_os = "macos") { "Library/Application Support" } else { ".local/state" };
        let base = from("XDG_STATE_HOME")
            .or_else(|| from("LOCALAPPDATA"))
            .or_else(|| from("HOME").map(|folder| folder.join(home)));
        Self { file: base.map(|base| base.join("splashdown").join("recent.toml")) }
    }

    /// The list in this file.
    #[cfg(test)]
    fn in_file(file: PathBuf) -> Self {
        Self { file: Some(file) }
    }

    /// The entries, the newest first, and whether they exist. A missing file has none.
    ///
    /// # Errors
    /// A note, if the file is damaged.
    pub fn list(&self) -> Result<Vec<RecentFile>, String> {
        let entry = |path: PathBuf| RecentFile { exists: path.exists(), path };
        Ok(self.paths()?.into_iter().map(entry).collect())
    }

    /// Puts a path in front. A path that is not valid text is not remembered.
    ///
    /// # Errors
    /// A note, if the file cannot be written.
    pub fn add(&self, path: &Path) -> Result<(), String> {
        let Ok(path) = std::path::absolute(path) else { return Ok(()) };
        if path.to_str().is_none() {
            return Ok(());
        }
        // A damaged file is replaced.
        let mut paths = self.paths().unwrap_or_default();
        paths.retain(|other| *other != path);
        paths.insert(0, path);
        paths.truncate(LIMIT);
        self.write(&paths)
    }

    /// Forgets all entries.
    ///
    /// # Errors
    /// A note, if the file cannot be written.
    pub fn clear(&self) -> Result<(), String> {
        self.write(&[])
    }

    fn paths(&self) -> Result<Vec<PathBuf>, String> {
        let Some(file) = self.file.as_ref().filter(|file| file.exists()) else { return Ok(Vec::new()) };
        let damaged = |reason: &str| {
            let name = file.display();
            format!(
                "the list of recent files, `{name}`, is ignored: {reason}. Opening a file writes a new list"
            )
        };
        let text = read(file).map_err(|reason| damaged(&reason))?;
        let document: DocumentMut = text.parse().map_err(|_| damaged("it is damaged"))?;
        let list = document.get(KEY).and_then(|item| item.as_array());
        let paths =
            list.and_then(|list| list.iter().map(|entry| entry.as_str().map(PathBuf::from)).collect());
        let mut paths: Vec<PathBuf> = paths.ok_or_else(|| damaged("it is not a list of paths"))?;
        paths.truncate(LIMIT);
        Ok(paths)
    }

    fn write(&self, paths: &[PathBuf]) -> Result<(), String> {
        let Some(file) = &self.file else { return Ok(()) };
        let mut list: Array = paths.iter().filter_map(|path| path.to_str()).collect();
        list.iter_mut().for_each(|entry| entry.decor_mut().set_prefix("\n    "));
        list.set_trailing("\n");
        let mut document = DocumentMut::new();
        document.insert(KEY, value(list));
        let write = || -> std::io::Result<()> {
            fs::create_dir_all(file.parent().unwrap_or(Path::new(".")))?;
            // Another window never reads half a list. A list that is lost when the power fails is no harm.
            let partial = file.with_extension(format!("{}.partial", std::process::id()));
            fs::write(&partial, document.to_string())?;
            fs::rename(&partial, file).inspect_err(|_| drop(fs::remove_file(&partial)))
        };
        write().map_err(|error| {
            format!("the list of recent files, `{}`, was not written: {error}", file.display())
        })
    }
}

/// The text of the file, if it is a short one: anything else in its place could be endless.
fn read(file: &Path) -> Result<String, String> {
    if !file.is_file() {
        return Err("it is not a file".to_owned());
    }
    let mut text = String::new();
    let opened = fs::File::open(file).map_err(|error| error.to_string())?;
    opened.take(MAX_BYTES).read_to_string(&mut text).map_err(|error| error.to_string())?;
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    type Outcome = Result<(), Box<dyn std::error::Error>>;

    fn names(files: &RecentFiles) -> Vec<String> {
        let name = |entry: RecentFile| entry.path.file_name().unwrap().to_string_lossy().into_owned();
        files.list().unwrap().into_iter().map(name).collect()
    }

    #[test]
    fn the_last_ten_are_listed_and_the_newest_is_first() -> Outcome {
        let folder = tempfile::tempdir()?;
        let files = RecentFiles::in_file(folder.path().join("state/recent.toml"));
        assert_eq!(names(&files), [""; 0]);
        let name = |number: u32| format!("a \"{number}\".toml");
        for number in 0..12 {
            files.add(&folder.path().join(name(number)))?;
        }
        files.add(&folder.path().join(name(5)))?;
        let expected = [5, 11, 10, 9, 8, 7, 6, 4, 3, 2].map(name);
        assert_eq!(names(&files), expected);
        // A relative path is that of the current folder.
        files.add(Path::new("Cargo.toml"))?;
        let listed = files.list()?;
        assert_eq!(listed[0], RecentFile { path: std::path::absolute("Cargo.toml")?, exists: true });
        assert!(!listed[1].exists && listed.len() == 10);
        files.clear()?;
        assert_eq!(names(&files), [""; 0]);
        Ok(())
    }

    #[test]
    fn a_damaged_file_is_ignored_and_replaced() -> Outcome {
        let folder = tempfile::tempdir()?;
        let file = folder.path().join("recent.toml");
        let files = RecentFiles::in_file(file.clone());
        for content in [&b"recent = [\"/a\""[..], b"recent = [1, 2]", b"other = 1", b"\xff\xfe"] {
            fs::write(&file, content)?;
            let note = files.list().unwrap_err();
            assert!(note.contains("recent.toml"), "{note}");
            files.add(Path::new("/b"))?;
            assert_eq!(names(&files), ["b"]);
        }
        // Control: a list is read.
        fs::write(&file, "recent = [\"/a\", \"/c\"]")?;
        assert_eq!(names(&files), ["a", "c"]);
        Ok(())
    }

    #[test]
    fn a_folder_that_cannot_be_written_is_a_note() -> Outcome {
        let folder = tempfile::tempdir()?;
        fs::write(folder.path().join("state"), "a file in place of the folder")?;
        let files = RecentFiles::in_file(folder.path().join("state/recent.toml"));
        let note = files.add(Path::new("/a")).unwrap_err();
        assert!(note.contains("was not written"), "{note}");
        assert_eq!(files.list()?, []);
        let none = RecentFiles { file: None };
        none.add(Path::new("/a"))?;
        assert_eq!(none.list()?, []);
        Ok(())
    }
}
