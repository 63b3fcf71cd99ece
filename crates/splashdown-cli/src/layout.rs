//! Where the results of a run lie below its output folder.

use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};

use splashdown::Checkpoint;
use splashdown::scene::{Choice, Format, PictureKind, Scene};
use splashdown_io::{IoError, WrittenFile, prepare_folder};

/// The names of all files of a run.
#[derive(Clone, Debug)]
pub struct Layout {
    root: PathBuf,
    digits: usize,
}

/// Folders below the root, with the stems and endings of the numbered files that a run writes there.
const FOLDERS: [(&str, &[&str], &[&str]); 3] = [
    ("particles", &["particles", "spray", "foam", "bubbles"], &["ply", "vtu", "vtk", "bgeo", "npz"]),
    ("mesh", &["surface"], &["ply", "obj", "vtk", "stl", "glb"]),
    ("pictures", &["surface", "particles"], &["png"]),
];

/// Animated files of runs that went on after a stop.
const ANIMATED: (&str, &[&str], &[&str]) = ("", &["surface", "particles"], &["usda"]);

/// How checkpoints are named.
const CHECKPOINT: &str = "checkpoint";

/// The folder of the probes' files, which are named by the scene.
const PROBES: &str = "probes";
/// How these files begin.
const PROBES_BEGIN: &[u8] = b"time (s),";

impl Layout {
    /// Names for this many frames: four digits, more if they are needed.
    pub fn new(root: PathBuf, frames: u32) -> Self {
        Self { root, digits: frames.to_string().len().max(4) }
    }

    /// Names with this many digits.
    pub fn with_digits(root: PathBuf, digits: usize) -> Self {
        Self { root, digits: digits.clamp(4, 10) }
    }

    /// The digits of the frames' numbers.
    pub fn digits(&self) -> usize {
        self.digits
    }

    /// The folder of the checkpoints.
    pub const CHECKPOINTS: &str = "checkpoints";

    /// The output folder.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// Particles of a frame.
    pub fn particles(&self, frame: u32, ending: &str) -> PathBuf {
        self.numbered("particles", "particles", frame, ending)
    }

    /// Spray, foam or bubbles of a frame.
    pub fn diffuse(&self, name: &str, frame: u32, ending: &str) -> PathBuf {
        self.numbered("particles", name, frame, ending)
    }

    /// The surface of a frame.
    pub fn mesh(&self, frame: u32, ending: &str) -> PathBuf {
        self.numbered("mesh", "surface", frame, ending)
    }

    /// A picture of a frame.
    pub fn picture(&self, kind: PictureKind, frame: u32) -> PathBuf {
        self.numbered("pictures", kind.name(), frame, "png")
    }

    /// The names of all pictures of a kind, as ffmpeg takes them.
    pub fn picture_pattern(&self, kind: PictureKind) -> String {
        let name = format!("{}_%0{}d.png", kind.name(), self.digits);
        self.root.join("pictures").join(name).display().to_string()
    }

    /// The film of the pictures of a kind.
    pub fn film(&self, kind: PictureKind) -> PathBuf {
        self.root.join(format!("{}.mp4", kind.name()))
    }

    /// The animated file of the surface or the particles, from this frame on or of all.
    pub fn animated(&self, kind: PictureKind, first: Option<u32>) -> PathBuf {
        match first {
            Some(frame) => self.numbered("", kind.name(), frame, "usda"),
            None => self.root.join(format!("{}.usda", kind.name())),
        }
    }

    /// ParaView's index of the particles, and how it names the particles of a frame.
    pub fn index(&self) -> PathBuf {
        self.root.join("particles").join("particles.pvd")
    }

    /// The readings of a probe.
    pub fn probe(&self, name: &str) -> PathBuf {
        self.root.join(PROBES).join(format!("{name}.csv"))
    }

    /// The summary.
    pub fn report(&self) -> PathBuf {
        self.root.join("run.json")
    }

    /// The checkpoint after a frame.
    pub fn checkpoint(&self, frame: u32) -> PathBuf {
        self.numbered(Self::CHECKPOINTS, CHECKPOINT, frame, Checkpoint::ENDING)
    }

    /// All checkpoints, the oldest first.
    pub fn checkpoints(&self) -> Vec<PathBuf> {
        let folder = self.root.join(Self::CHECKPOINTS);
        let mut files: Vec<(u32, PathBuf)> = fs::read_dir(folder)
            .into_iter()
            .flatten()
            .flatten()
            .filter_map(|entry| {
                let name = entry.file_name();
                let number = frame_number(&name.to_string_lossy(), &[CHECKPOINT], &[Checkpoint::ENDING])?;
                Some((number, entry.path()))
            })
            .collect();
        files.sort();
        files.into_iter().map(|(_, path)| path).collect()
    }

    /// Makes the folder of the checkpoints.
    ///
    /// # Errors
    /// [`IoError::Write`].
    pub fn make_checkpoints(&self) -> Result<(), IoError> {
        prepare_folder(&self.root.join(Self::CHECKPOINTS))
    }

    /// Removes all checkpoints but the newest.
    pub fn keep_checkpoints(&self, kept: usize) {
        let files = self.checkpoints();
        for old in &files[..files.len().saturating_sub(kept)] {
            // One that stays is in nobody's way.
            let _ = fs::remove_file(old);
        }
    }

    /// Removes frames and checkpoints of a run that goes on after this frame, and ends elsewhere than before perhaps.
    pub fn remove_after(&self, frame: u32) {
        let checkpoints = (Self::CHECKPOINTS, &[CHECKPOINT][..], &[Checkpoint::ENDING][..]);
        for (folder, stems, endings) in FOLDERS.into_iter().chain([checkpoints, ANIMATED]) {
            for entry in fs::read_dir(self.root.join(folder)).into_iter().flatten().flatten() {
                let number = frame_number(&entry.file_name().to_string_lossy(), stems, endings);
                if number.is_some_and(|number| number > frame) {
                    // What cannot be removed cannot be overwritten either, and that is then reported with its name.
                    let _ = fs::remove_file(entry.path());
                }
            }
        }
    }

    /// The files of a run up to this frame that are there, but for its films, probes, index and report.
    pub fn files_up_to(&self, frame: u32) -> Vec<WrittenFile> {
        let mut files = Vec::new();
        let mut add = |path: PathBuf| {
            if let Ok(data) = fs::metadata(&path) {
                files.push(WrittenFile { path, bytes: data.len() });
            }
        };
        let checkpoints = (Self::CHECKPOINTS, &[CHECKPOINT][..], &[Checkpoint::ENDING][..]);
        for (folder, stems, endings) in FOLDERS.into_iter().chain([checkpoints, ANIMATED]) {
            for entry in fs::read_dir(self.root.join(folder)).into_iter().flatten().flatten() {
                let number = frame_number(&entry.file_name().to_string_lossy(), stems, endings);
                if number.is_some_and(|number| number <= frame) {
                    add(self.root.join(folder).join(entry.file_name()));
                }
            }
        }
        for (kind, ..) in PictureKind::ALL {
            add(self.animated(*kind, None));
        }
        files
    }

    fn numbered(&self, folder: &str, stem: &str, frame: u32, ending: &str) -> PathBuf {
        self.root.join(folder).join(format!("{stem}_{frame:0digits$}.{ending}", digits = self.digits))
    }

    /// Makes the folders that are wanted and finds out whether they can be written.
    ///
    /// # Errors
    /// [`IoError::Write`].
    pub fn make(&self, wanted: Folders) -> Result<(), IoError> {
        prepare_folder(&self.root)?;
        let wanted_probes = wanted.probes;
        let wanted = [wanted.particles, wanted.mesh, wanted.pictures];
        for ((folder, ..), _) in FOLDERS.iter().zip(wanted).filter(|(_, wanted)| *wanted) {
            prepare_folder(&self.root.join(folder))?;
        }
        if wanted_probes {
            prepare_folder(&self.root.join(PROBES))?;
        }
        Ok(())
    }

    /// Where an earlier run left its report, the files that a run writes are removed, and only those: frames of
    /// two runs in one series would be read as one. Returns their number.
    pub fn remove_earlier(&self) -> usize {
        if !self.report().exists() {
            return 0;
        }
        let mut files = 0;
        // What cannot be removed cannot be overwritten either, and that is then reported with its name.
        let mut remove = |path: &Path| files += usize::from(fs::remove_file(path).is_ok());
        remove(&self.index());
        for (folder, stems, endings) in FOLDERS.into_iter().chain([ANIMATED]) {
            let folder = self.root.join(folder);
            for entry in fs::read_dir(&folder).into_iter().flatten().flatten() {
                if frame_number(&entry.file_name().to_string_lossy(), stems, endings).is_some() {
                    remove(&entry.path());
                }
            }
            // Succeeds only if nothing else is in it.
            let _ = fs::remove_dir(&folder);
        }
        let probes = self.root.join(PROBES);
        for entry in fs::read_dir(&probes).into_iter().flatten().flatten() {
            if is_log(&entry.path()) {
                remove(&entry.path());
            }
        }
        let _ = fs::remove_dir(&probes);
        for checkpoint in self.checkpoints() {
            remove(&checkpoint);
        }
        let _ = fs::remove_dir(self.root.join(Self::CHECKPOINTS));
        remove(&self.report());
        for (kind, ..) in PictureKind::ALL {
            remove(&self.film(*kind));
            remove(&self.animated(*kind, None));
        }
        files
    }
}

/// The folders that a run needs below its output folder.
#[derive(Clone, Copy, Debug)]
pub struct Folders {
    /// For particles.
    pub particles: bool,
    /// For the surface.
    pub mesh: bool,
    /// For pictures.
    pub pictures: bool,
    /// For what probes measure.
    pub probes: bool,
}

impl Folders {
    /// Those that the scene's formats need.
    pub fn of(scene: &Scene, surface: bool, pictures: bool) -> Self {
        let any = |wanted: fn(Format) -> bool| {
            scene.output.formats.iter().any(|&format| format.is_numbered() && wanted(format))
        };
        Self {
            particles: any(Format::has_particles),
            mesh: surface && any(Format::has_surface),
            pictures,
            probes: !scene.probes.is_empty(),
        }
    }
}

/// True for what a probe has written, whatever its name.
fn is_log(path: &Path) -> bool {
    let mut begin = [0; PROBES_BEGIN.len()];
    let read = fs::File::open(path).and_then(|mut file| file.read_exact(&mut begin));
    path.extension().is_some_and(|ending| ending == "csv") && read.is_ok() && begin == PROBES_BEGIN
}

/// The number in `stem_0123.ending`, which has at least four digits.
fn frame_number(name: &str, stems: &[&str], endings: &[&str]) -> Option<u32> {
    let number = |(stem, ending): (&str, &str)| {
        let digits = name.strip_prefix(stem)?.strip_prefix('_')?.strip_suffix(ending)?.strip_suffix('.')?;
        let all = digits.len() >= 4 && digits.bytes().all(|digit| digit.is_ascii_digit());
        digits.parse().ok().filter(|_| all)
    };
    stems.iter().find_map(|&stem| endings.iter().find_map(|&ending| number((stem, ending))))
}

#[cfg(test)]
mod tests {
    use super::{Folders, Layout, frame_number};
    use splashdown::scene::PictureKind;
    use std::fs;

    #[test]
    fn names_have_four_digits_or_as_many_as_needed() {
        let layout = Layout::new("out".into(), 100);
        assert!(layout.particles(7, "ply").ends_with("particles/particles_0007.ply"));
        assert!(layout.picture_pattern(PictureKind::Surface).ends_with("surface_%04d.png"));
        let layout = Layout::new("out".into(), 12_000);
        assert!(layout.mesh(7, "obj").ends_with("mesh/surface_00007.obj"));
        assert!(layout.picture_pattern(PictureKind::Particles).ends_with("particles_%05d.png"));
    }

    #[test]
    fn only_the_frames_of_a_run_are_taken_for_such() {
        let yes = ["particles_0000.ply", "particles_12345.vtu"];
        let no = [
            "particles_000.ply",
            "particles_00a0.ply",
            "particles_0000.obj",
            "my_0000.ply",
            "particles_0000ply",
            "particles_.ply",
        ];
        assert!(
            yes.map(|name| frame_number(name, &["particles"], &["ply", "vtu"])) == [Some(0), Some(12_345)]
        );
        assert!(!no.iter().any(|name| frame_number(name, &["particles"], &["ply", "vtu"]).is_some()));
    }

    #[test]
    fn an_earlier_run_is_removed_and_nothing_else() -> Result<(), Box<dyn std::error::Error>> {
        let folder = tempfile::tempdir()?;
        let layout = Layout::new(folder.path().to_owned(), 10);
        layout.make(Folders { particles: true, mesh: true, pictures: true, probes: true })?;
        let mine = folder.path().join("particles/notes.txt");
        let frame = layout.particles(3, "ply");
        fs::write(&mine, "mine")?;
        fs::write(&frame, "old")?;
        fs::write(layout.probe("gauge"), "time (s),height (m)\n")?;
        let other = layout.probe("measured");
        fs::write(&other, "seconds,metres\n")?;
        // Without a report the folder is not known to be ours.
        assert_eq!(layout.remove_earlier(), 0);
        assert!(frame.exists());
        fs::write(layout.report(), "{}")?;
        assert_eq!(layout.remove_earlier(), 3);
        assert!(!frame.exists() && mine.exists() && other.exists() && !layout.probe("gauge").exists());
        Ok(())
    }
}
