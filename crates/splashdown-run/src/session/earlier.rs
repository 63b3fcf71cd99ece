//! The earlier frames of a resumed run.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use splashdown::foam::DiffuseKind;
use splashdown::scene::{PictureKind, Scene};
use splashdown_io::WrittenFile;

use super::count_of;
use crate::RunFolder;

/// Number of missing files that a warning names.
const NAMED: usize = 3;

/// The files of the earlier frames.
#[derive(Debug)]
pub struct Earlier {
    /// The existing files.
    pub files: Vec<WrittenFile>,
    missing: Vec<PathBuf>,
}

impl Earlier {
    /// Looks for the files of the frames `since` to `last` that `scene` requests. Pictures count as missing only after
    /// the first existing one, because a run without a driver draws none.
    pub fn find(folder: &RunFolder, scene: &Scene, pictures: &[PictureKind], since: u32, last: u32) -> Self {
        let files = folder.files_up_to(last);
        let existing: HashSet<&Path> = files.iter().map(|file| file.path.as_path()).collect();
        let exists = |path: &PathBuf| existing.contains(path.as_path());
        let mut missing = Vec::new();
        for frame in since..=last {
            for format in scene.output.formats.iter().filter(|format| format.is_numbered()) {
                let ending = format.ending();
                if format.has_particles() {
                    missing.push(folder.particles(frame, ending));
                }
                if format.has_points() {
                    let kinds = DiffuseKind::ALL.iter().filter(|_| scene.foam.enabled);
                    missing.extend(kinds.map(|(_, name)| folder.points(name, frame, ending)));
                    let droplets = scene.surface.separates().then(|| folder.droplets(frame, ending));
                    missing.extend(droplets);
                }
                if format.has_surface() && scene.surface.enabled {
                    missing.push(folder.mesh(frame, ending));
                }
            }
        }
        for &kind in pictures {
            let all = (0..=last).map(|frame| folder.picture(kind, frame));
            missing.extend(all.skip_while(|path| !exists(path)));
        }
        missing.retain(|path| !exists(path));
        Self { files, missing }
    }

    /// A warning about missing files.
    pub fn warning(&self, root: &Path) -> Option<String> {
        let name = |path: &PathBuf| path.strip_prefix(root).unwrap_or(path).display().to_string();
        let mut names: Vec<String> = self.missing.iter().take(NAMED).map(name).collect();
        if self.missing.len() > NAMED {
            names.push("...".to_owned());
        }
        let count = count_of(self.missing.len(), "file");
        let text = format!("{count} of earlier frames cannot be found: {}", names.join(", "));
        (!names.is_empty()).then_some(text)
    }
}
