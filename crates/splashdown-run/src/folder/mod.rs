//! The output folder of a run and the names of its files.

mod clean;
mod create;
mod numbered;

pub(crate) use clean::remove_partial;
pub(crate) use create::Subfolders;
pub(crate) use numbered::{DROPLET_SERIES, DROPLETS, MESHES, PARTICLES, PARTICLES_STEM, SCENE_FILE, SURFACE};

use std::fs;
use std::path::{Path, PathBuf};

use splashdown::Checkpoint;
use splashdown::scene::{Choice, Format, PictureKind};
use splashdown_io::PART_ENDING;

use numbered::{CHECKPOINT, CHECKPOINTS, frame_number};

/// The folder of the probe tables, whose names come from the scene.
const PROBES: &str = "probes";
/// The folder of the tables and the meshes of the bodies.
const BODIES: &str = "bodies";
/// The ending of the mesh of a body.
const BODY_MESH_ENDING: &str = "ply";

/// The names of all files of a run.
#[derive(Clone, Debug)]
pub struct RunFolder {
    root: PathBuf,
    digits: usize,
}

impl RunFolder {
    /// Names for this many frames: four digits, more if necessary.
    pub fn new(root: PathBuf, frames: u32) -> Self {
        Self { root, digits: frames.to_string().len().max(4) }
    }

    /// Names with this many digits, 4 to 10.
    pub(crate) fn with_digits(root: PathBuf, digits: usize) -> Self {
        Self { root, digits: digits.clamp(4, 10) }
    }

    /// The digits of the frame numbers.
    pub(crate) fn digits(&self) -> usize {
        self.digits
    }

    /// The folder itself.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// Particles of a frame. `ending` has no dot.
    pub fn particles(&self, frame: u32, ending: &str) -> PathBuf {
        self.numbered(PARTICLES.folder, PARTICLES_STEM, frame, ending)
    }

    /// Spray, foam or bubbles of a frame.
    pub fn diffuse(&self, name: &str, frame: u32, ending: &str) -> PathBuf {
        self.numbered("particles", name, frame, ending)
    }

    /// Droplets of a frame.
    pub fn droplets(&self, frame: u32, ending: &str) -> PathBuf {
        self.numbered(DROPLETS, DROPLETS, frame, ending)
    }

    /// Droplets, spray, foam or bubbles of a frame, by the stem of the file name.
    pub(crate) fn points(&self, name: &str, frame: u32, ending: &str) -> PathBuf {
        if name == DROPLETS { self.droplets(frame, ending) } else { self.diffuse(name, frame, ending) }
    }

    /// The surface of a frame.
    pub fn mesh(&self, frame: u32, ending: &str) -> PathBuf {
        self.numbered(MESHES.folder, SURFACE, frame, ending)
    }

    /// Particles, points or the surface of a frame, by the stem of the file name.
    pub(crate) fn file(&self, stem: &str, frame: u32, ending: &str) -> PathBuf {
        if stem == SURFACE { self.mesh(frame, ending) } else { self.points(stem, frame, ending) }
    }

    /// A picture of a frame.
    pub fn picture(&self, kind: PictureKind, frame: u32) -> PathBuf {
        self.numbered("pictures", kind.name(), frame, "png")
    }

    /// The names of all pictures of a kind, in the notation of ffmpeg.
    pub fn picture_pattern(&self, kind: PictureKind) -> String {
        let name = format!("{}_%0{}d.png", kind.name(), self.digits);
        self.root.join("pictures").join(name).display().to_string()
    }

    /// The film of the pictures of a kind.
    pub fn film(&self, kind: PictureKind) -> PathBuf {
        self.root.join(format!("{}.mp4", kind.name()))
    }

    /// A file with all frames, or those from `first` on: `scene` or `particles`, with an ending without a dot.
    pub fn animated_file(&self, stem: &str, first: Option<u32>, ending: &str) -> PathBuf {
        match first {
            Some(frame) => self.numbered("", stem, frame, ending),
            None => self.root.join(format!("{stem}.{ending}")),
        }
    }

    /// The complete files with all frames.
    pub(crate) fn animated_files(&self) -> impl Iterator<Item = PathBuf> {
        let endings =
            Format::ALL.iter().filter(|(format, ..)| format.has_scene()).map(|(format, ..)| format.ending());
        let stems = numbered::ANIMATED.stems.iter();
        endings.flat_map(move |ending| stems.clone().map(move |stem| self.animated_file(stem, None, ending)))
    }

    /// The first frame of the file that a run resumed after a frame continues: the last one that begins before. `None` is
    /// the file with all frames.
    pub(crate) fn animated_at(&self, stem: &str, last: u32) -> Option<u32> {
        let files = numbered::ANIMATED.files(&self.root);
        let own = files
            .chain(self.numbered_parts())
            .filter(|(first, path)| *first <= last && file_name(path).starts_with(stem));
        own.map(|(first, _)| first).max()
    }

    /// The data of files that do not begin with the first frame, with the number of their first frame: that of
    /// `scene_0006.usdc` is `scene_0006.scenepart`.
    pub(crate) fn numbered_parts(&self) -> impl Iterator<Item = (u32, PathBuf)> {
        self.scene_parts().into_iter().filter_map(|path| {
            let number = path.file_stem()?.to_str()?.rsplit_once('_')?.1.parse().ok()?;
            Some((number, path))
        })
    }

    /// The data of files with all frames that are not complete yet.
    pub(crate) fn scene_parts(&self) -> Vec<PathBuf> {
        let entries = fs::read_dir(self.checkpoint_folder()).into_iter().flatten().flatten();
        let files = entries.map(|entry| entry.path());
        files.filter(|path| path.extension().is_some_and(|ending| ending == PART_ENDING)).collect()
    }

    /// Renames such data of a file that the run does not write any more, as [`StageFile::resume`] does.
    ///
    /// [`StageFile::resume`]: splashdown_io::StageFile::resume
    pub(crate) fn set_aside(&self, stem: &str) {
        for part in self.scene_parts().into_iter().filter(|path| file_name(path).starts_with(stem)) {
            // Data that cannot be renamed is left as it is.
            let _ = fs::rename(&part, part.with_extension(format!("{PART_ENDING}.old")));
        }
    }

    /// Whether there is such data of this file.
    pub(crate) fn has_scene_part(&self, stem: &str) -> bool {
        self.scene_parts().iter().any(|path| file_name(path).starts_with(stem))
    }

    /// ParaView's index of the particles in VTU or VTP files.
    pub fn index(&self) -> PathBuf {
        self.index_of(PARTICLES_STEM)
    }

    /// ParaView's index of the files of this stem, beside them.
    pub(crate) fn index_of(&self, stem: &str) -> PathBuf {
        self.file(stem, 0, "").with_file_name(format!("{stem}.pvd"))
    }

    /// The possible indices.
    pub(crate) fn indices(&self) -> impl Iterator<Item = PathBuf> {
        let stems = [PARTICLES, DROPLET_SERIES, MESHES].into_iter().flat_map(|series| series.stems);
        stems.map(move |stem| self.index_of(stem))
    }

    /// The table of a probe.
    pub fn probe(&self, name: &str) -> PathBuf {
        self.root.join(PROBES).join(format!("{name}.csv"))
    }

    /// The table of a body.
    pub fn body(&self, name: &str) -> PathBuf {
        self.root.join(BODIES).join(format!("{name}.csv"))
    }

    /// The mesh of a body.
    pub fn body_mesh(&self, name: &str) -> PathBuf {
        self.root.join(BODIES).join(format!("{name}.{BODY_MESH_ENDING}"))
    }

    /// The report.
    pub fn report(&self) -> PathBuf {
        self.root.join("run.json")
    }

    /// The checkpoint after a frame.
    pub fn checkpoint(&self, frame: u32) -> PathBuf {
        self.numbered(CHECKPOINTS, CHECKPOINT, frame, Checkpoint::ENDING)
    }

    /// The folder of the checkpoints.
    pub fn checkpoint_folder(&self) -> PathBuf {
        self.root.join(CHECKPOINTS)
    }

    /// All checkpoints, the oldest first.
    pub fn checkpoints(&self) -> Vec<PathBuf> {
        let mut files: Vec<(u32, PathBuf)> = fs::read_dir(self.checkpoint_folder())
            .into_iter()
            .flatten()
            .flatten()
            .filter_map(|entry| {
                let name = entry.file_name();
                let number = frame_number(&name.to_string_lossy(), &[CHECKPOINT], |ending| {
                    ending == Checkpoint::ENDING
                })?;
                Some((number, entry.path()))
            })
            .collect();
        files.sort();
        files.into_iter().map(|(_, path)| path).collect()
    }

    /// The run whose folder of checkpoints this is, if it is one.
    pub(crate) fn root_of_checkpoints(folder: &Path) -> Option<PathBuf> {
        if folder.ends_with(CHECKPOINTS) {
            let root = folder.parent()?;
            return Some(if root.as_os_str().is_empty() { PathBuf::from(".") } else { root.to_owned() });
        }
        // The folder may be given relative to itself, as `.`.
        let whole = folder.canonicalize().ok().filter(|folder| folder.ends_with(CHECKPOINTS))?;
        whole.parent().map(Path::to_owned)
    }

    fn numbered(&self, folder: &str, stem: &str, frame: u32, ending: &str) -> PathBuf {
        self.root.join(folder).join(format!("{stem}_{frame:0digits$}.{ending}", digits = self.digits))
    }
}

fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

#[cfg(test)]
mod tests {
    use super::RunFolder;
    use splashdown::scene::PictureKind;

    #[test]
    fn names_have_at_least_four_digits() {
        let folder = RunFolder::new("out".into(), 100);
        assert!(folder.particles(7, "ply").ends_with("particles/particles_0007.ply"));
        assert!(folder.picture_pattern(PictureKind::Surface).ends_with("surface_%04d.png"));
        let folder = RunFolder::new("out".into(), 12_000);
        assert!(folder.mesh(7, "obj").ends_with("mesh/surface_00007.obj"));
        assert!(folder.picture_pattern(PictureKind::Particles).ends_with("particles_%05d.png"));
    }
}
