//! What a run that goes on finds of its frames before.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use splashdown::DiffuseKind;
use splashdown::scene::{Choice, PictureKind, Scene};
use splashdown_io::WrittenFile;

use crate::human;
use crate::layout::Layout;

/// How many names of missing files are told.
const NAMED: usize = 3;

/// The files of the frames before.
#[derive(Debug)]
pub struct Earlier {
    /// Those that are there.
    pub files: Vec<WrittenFile>,
    missing: Vec<PathBuf>,
}

impl Earlier {
    /// Looks for the files of the frames `since` to `last` that `scene` asks for. Of pictures, which a missing
    /// driver may have kept from being drawn, those are missed that come after another one.
    pub fn find(layout: &Layout, scene: &Scene, pictures: &[PictureKind], since: u32, last: u32) -> Self {
        let files = layout.files_up_to(last);
        let there: HashSet<&Path> = files.iter().map(|file| file.path.as_path()).collect();
        let is_there = |path: &PathBuf| there.contains(path.as_path());
        let mut missing = Vec::new();
        for frame in since..=last {
            for format in scene.output.formats.iter().filter(|format| format.is_numbered()) {
                let ending = format.name();
                if format.has_particles() {
                    missing.push(layout.particles(frame, ending));
                    let kinds = DiffuseKind::ALL.iter().filter(|_| scene.foam.enabled);
                    missing.extend(kinds.map(|(_, name)| layout.diffuse(name, frame, ending)));
                }
                if format.has_surface() && scene.surface.enabled {
                    missing.push(layout.mesh(frame, ending));
                }
            }
        }
        for &kind in pictures {
            let all = (0..=last).map(|frame| layout.picture(kind, frame));
            missing.extend(all.skip_while(|path| !is_there(path)));
        }
        missing.retain(|path| !is_there(path));
        Self { files, missing }
    }

    /// A sentence about files that are not there any more.
    pub fn warning(&self, root: &Path) -> Option<String> {
        let name = |path: &PathBuf| path.strip_prefix(root).unwrap_or(path).display().to_string();
        let mut names: Vec<String> = self.missing.iter().take(NAMED).map(name).collect();
        if self.missing.len() > NAMED {
            names.push("...".to_owned());
        }
        let count = human::counted(self.missing.len() as u64, "file");
        let text = format!("{count} of the frames before cannot be found any more: {}", names.join(", "));
        (!names.is_empty()).then_some(text)
    }
}
