//! Finding and removing the files of earlier runs.
//!
//! Failures to remove a file are ignored here. Such a file cannot be overwritten either, and that failure is reported
//! with its name.

use std::fs;
use std::io::Read;
use std::path::Path;

use splashdown::scene::{Choice, PictureKind};
use splashdown_io::WrittenFile;

use super::{BODIES, BODY_MESH_ENDING, PROBES, RunFolder, numbered};

/// The first bytes of the table of a probe or body.
const TABLE_HEADER: &[u8] = b"time (s),";

impl RunFolder {
    /// Removes all checkpoints but the newest `count`.
    pub(crate) fn remove_old_checkpoints(&self, count: usize) {
        let files = self.checkpoints();
        for old in &files[..files.len().saturating_sub(count)] {
            // A checkpoint that cannot be removed is harmless.
            let _ = fs::remove_file(old);
        }
    }

    /// Removes frames and checkpoints after this frame, because a resumed run may end earlier than the original run.
    pub(crate) fn remove_after(&self, frame: u32) {
        for series in numbered::ALL {
            for (_, path) in series.files(&self.root).filter(|(number, _)| *number > frame) {
                let _ = fs::remove_file(path);
            }
        }
        for (_, path) in self.numbered_parts().filter(|(first, _)| *first > frame) {
            let _ = fs::remove_file(path);
        }
    }

    /// The existing files of the frames up to this one. Films, tables, index and report are not included.
    pub(crate) fn files_up_to(&self, frame: u32) -> Vec<WrittenFile> {
        let numbered = numbered::ALL.iter().flat_map(|series| series.files(&self.root));
        let numbered = numbered.filter(|(number, _)| *number <= frame).map(|(_, path)| path);
        let existing = |path: std::path::PathBuf| {
            let bytes = fs::metadata(&path).ok()?.len();
            Some(WrittenFile { path, bytes })
        };
        numbered.chain(self.animated_files()).filter_map(existing).collect()
    }

    /// Removes the files of an earlier run, if the folder contains its report. Other files remain. Without this, the
    /// frames of both runs would be read as one series. Returns the number of files removed.
    pub(crate) fn remove_earlier(&self) -> usize {
        if !self.report().exists() {
            return 0;
        }
        let mut files = 0;
        let mut remove = |path: &Path| files += usize::from(fs::remove_file(path).is_ok());
        self.indices().for_each(|index| remove(&index));
        for series in numbered::ALL {
            for (_, path) in series.files(&self.root) {
                remove(&path);
            }
            // Succeeds only if the folder is empty.
            let _ = fs::remove_dir(self.root.join(series.folder));
        }
        for part in self.scene_parts() {
            remove(&part);
        }
        let _ = fs::remove_dir(self.checkpoint_folder());
        for tables in [PROBES, BODIES].map(|name| self.root.join(name)) {
            for entry in fs::read_dir(&tables).into_iter().flatten().flatten() {
                let path = entry.path();
                if is_table(&path) {
                    remove(&path);
                    // The mesh of a body is next to its table.
                    if tables.ends_with(BODIES) {
                        remove(&path.with_extension(BODY_MESH_ENDING));
                    }
                }
            }
            let _ = fs::remove_dir(&tables);
        }
        remove(&self.report());
        for (kind, ..) in PictureKind::ALL {
            remove(&self.film(*kind));
        }
        for path in self.animated_files() {
            remove(&path);
        }
        files
    }
}

/// Removes the incomplete files of a killed run from its folder and the subfolders.
pub(crate) fn remove_partial(root: &Path) {
    let folders = fs::read_dir(root).into_iter().flatten().flatten().map(|entry| entry.path());
    for folder in folders.filter(|path| path.is_dir()).chain([root.to_owned()]) {
        for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
            let name = entry.file_name();
            let name = name.to_string_lossy();
            if name.starts_with('.') && name.ends_with(".partial") {
                let _ = fs::remove_file(entry.path());
            }
        }
    }
}

/// Whether a file is the table of a probe or body. Its content decides, because the scene chooses the names.
fn is_table(path: &Path) -> bool {
    let mut start = [0; TABLE_HEADER.len()];
    let read = fs::File::open(path).and_then(|mut file| file.read_exact(&mut start));
    path.extension().is_some_and(|ending| ending == "csv") && read.is_ok() && start == TABLE_HEADER
}

#[cfg(test)]
mod tests {
    use super::super::{RunFolder, Subfolders};
    use std::fs;

    #[test]
    fn an_earlier_run_is_removed_and_nothing_else() -> Result<(), Box<dyn std::error::Error>> {
        let temporary = tempfile::tempdir()?;
        let folder = RunFolder::new(temporary.path().to_owned(), 10);
        let all = Subfolders {
            particles: true,
            droplets: true,
            mesh: true,
            pictures: true,
            probes: true,
            bodies: true,
            checkpoints: false,
        };
        folder.create_subfolders(all)?;
        let mine = temporary.path().join("particles/notes.txt");
        let frame = folder.particles(3, "ply");
        let index = folder.index_of("surface");
        assert!(index.ends_with("mesh/surface.pvd") && folder.index().ends_with("particles/particles.pvd"));
        fs::write(&mine, "mine")?;
        fs::write(&frame, "old")?;
        fs::write(&index, "old")?;
        fs::write(folder.probe("gauge"), "time (s),height (m)\n")?;
        fs::write(folder.body("crate"), "time (s),position x (m)\n")?;
        fs::write(folder.body_mesh("crate"), "ply")?;
        fs::write(folder.body_mesh("boat"), "ply")?;
        let other = folder.probe("measured");
        fs::write(&other, "seconds,metres\n")?;
        // Without a report the folder may belong to another program.
        assert_eq!(folder.remove_earlier(), 0);
        assert!(frame.exists());
        fs::write(folder.report(), "{}")?;
        // Frame, index, two tables, mesh of the body, report.
        assert_eq!(folder.remove_earlier(), 6);
        assert!(
            !frame.exists()
                && !index.exists()
                && mine.exists()
                && other.exists()
                && !folder.probe("gauge").exists()
        );
        assert!(!folder.body("crate").exists() && !folder.body_mesh("crate").exists());
        // Without a table, the mesh is a file of the user.
        assert!(folder.body_mesh("boat").exists());
        Ok(())
    }
}
