//! The scenes and runs that were opened last, in a small file of the user.
//!
//! The list is a convenience: a file that is missing, damaged or cannot be written never prevents anything else.

use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};

use toml_edit::{Array, DocumentMut, InlineTable, Value, value};

use crate::state::RecentFile;

/// Number of entries.
const LIMIT: usize = 10;
/// Size of the largest file that is read, in bytes. Ten paths are shorter.
const MAX_BYTES: u64 = 64 << 10;
/// The key in the file.
const KEY: &str = "recent";
/// The keys of an entry with a scene. Others are a path alone.
const PATH: &str = "path";
const SCENE: &str = "scene";

/// An entry of the list.
#[derive(Clone, Debug, PartialEq)]
struct Entry {
    path: PathBuf,
    /// The scene of a run that does not name it.
    scene: Option<PathBuf>,
}

impl Entry {
    fn read(value: &Value) -> Option<Self> {
        if let Some(path) = value.as_str() {
            return Some(Self { path: path.into(), scene: None });
        }
        let table = value.as_inline_table()?;
        let path = |key: &str| table.get(key).and_then(Value::as_str).map(PathBuf::from);
        Some(Self { path: path(PATH)?, scene: path(SCENE) })
    }

    /// `None` if a path is not valid text.
    fn write(&self) -> Option<Value> {
        let path = self.path.to_str()?;
        let Some(scene) = &self.scene else { return Some(path.into()) };
        let mut table = InlineTable::new();
        table.insert(PATH, path.into());
        table.insert(SCENE, scene.to_str()?.into());
        Some(table.into())
    }
}

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
        let entry = |Entry { path, scene }: Entry| RecentFile { exists: path.exists(), path, scene };
        Ok(self.entries()?.into_iter().map(entry).collect())
    }

    /// Puts a path in front, with the scene of a run that does not name it. A path that is not valid text is not remembered.
    ///
    /// # Errors
    /// A note, if the file cannot be written.
    pub fn add(&self, path: &Path, scene: Option<&Path>) -> Result<(), String> {
        // The name of a built-in scene is not a file.
        let scene = scene.map(|scene| if scene.exists() { absolute(scene) } else { scene.to_owned() });
        let entry = Entry { path: absolute(path), scene };
        if entry.write().is_none() {
            return Ok(());
        }
        // A damaged file is replaced.
        let mut entries = self.entries().unwrap_or_default();
        entries.retain(|other| absolute(&other.path) != entry.path);
        entries.insert(0, entry);
        entries.truncate(LIMIT);
        self.write(&entries)
    }

    /// Forgets all entries.
    ///
    /// # Errors
    /// A note, if the file cannot be written.
    pub fn clear(&self) -> Result<(), String> {
        self.write(&[])
    }

    fn entries(&self) -> Result<Vec<Entry>, String> {
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
        let entries: Option<Vec<Entry>> = list.and_then(|list| list.iter().map(Entry::read).collect());
        let mut entries = entries.ok_or_else(|| damaged("it is not a list of paths"))?;
        entries.truncate(LIMIT);
        Ok(entries)
    }

    fn write(&self, entries: &[Entry]) -> Result<(), String> {
        let Some(file) = &self.file else { return Ok(()) };
        let mut list: Array = entries.iter().filter_map(Entry::write).collect();
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

/// The path from the root of the file system, without `..`. A relative one is that of the current folder.
fn absolute(path: &Path) -> PathBuf {
    let absolute = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    // On Windows the system removes `..`, and its canonical paths have a form that is hard to read.
    match cfg!(windows) {
        true => absolute,
        false => absolute.canonicalize().unwrap_or(absolute),
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
            files.add(&folder.path().join(name(number)), None)?;
        }
        files.add(&folder.path().join(name(5)), None)?;
        let expected = [5, 11, 10, 9, 8, 7, 6, 4, 3, 2].map(name);
        assert_eq!(names(&files), expected);
        // A relative path is that of the current folder.
        files.add(Path::new("src/../Cargo.toml"), None)?;
        let listed = files.list()?;
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).canonicalize()?.join("Cargo.toml");
        assert_eq!(listed[0], RecentFile { path, scene: None, exists: true });
        assert!(!listed[1].exists && listed.len() == 10);
        files.clear()?;
        assert_eq!(names(&files), [""; 0]);
        Ok(())
    }

    #[test]
    fn the_scene_of_a_run_is_remembered() -> Outcome {
        let folder = tempfile::tempdir()?;
        let files = RecentFiles::in_file(folder.path().join("recent.toml"));
        let scene = folder.path().canonicalize()?.join("a.toml");
        fs::write(&scene, "")?;
        fs::create_dir(folder.path().join("run"))?;
        files.add(&folder.path().join("run/../run"), Some(&folder.path().join("run/../a.toml")))?;
        files.add(Path::new("/other"), Some(Path::new("dam-break")))?;
        let scenes: Vec<_> = files.list()?.into_iter().map(|entry| entry.scene).collect();
        assert_eq!(scenes, [Some("dam-break".into()), Some(scene)]);
        // The same run without a scene replaces it.
        files.add(&folder.path().join("run"), None)?;
        let listed = files.list()?;
        assert_eq!((listed.len(), &listed[0].scene), (2, &None), "{listed:?}");
        Ok(())
    }

    #[test]
    fn a_damaged_file_is_ignored_and_replaced() -> Outcome {
        let folder = tempfile::tempdir()?;
        let file = folder.path().join("recent.toml");
        let files = RecentFiles::in_file(file.clone());
        for content in [
            &b"recent = [\"/a\""[..],
            b"recent = [1, 2]",
            b"recent = [{ scene = \"/a\" }]",
            b"other = 1",
            b"\xff\xfe",
        ] {
            fs::write(&file, content)?;
            let note = files.list().unwrap_err();
            assert!(note.contains("recent.toml"), "{note}");
            files.add(Path::new("/b"), None)?;
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
        let note = files.add(Path::new("/a"), None).unwrap_err();
        assert!(note.contains("was not written"), "{note}");
        assert_eq!(files.list()?, []);
        let none = RecentFiles { file: None };
        none.add(Path::new("/a"), None)?;
        assert_eq!(none.list()?, []);
        Ok(())
    }
}
