//! The numbered files of a run.

use std::fs;
use std::path::{Path, PathBuf};

use splashdown::Checkpoint;

/// The folder of the checkpoints.
pub const CHECKPOINTS: &str = "checkpoints";
/// The stem of their names.
pub const CHECKPOINT: &str = "checkpoint";

/// Files `STEM_NUMBER.ENDING` in a folder below the root.
#[derive(Clone, Copy, Debug)]
pub struct Series {
    pub folder: &'static str,
    stems: &'static [&'static str],
    endings: &'static [&'static str],
}

pub const PARTICLES: Series = Series {
    folder: "particles",
    stems: &["particles", "spray", "foam", "bubbles"],
    endings: &["ply", "vtu", "vtk", "bgeo", "npz"],
};
pub const MESHES: Series =
    Series { folder: "mesh", stems: &["surface"], endings: &["ply", "obj", "vtk", "stl", "glb"] };
pub const PICTURES: Series =
    Series { folder: "pictures", stems: &["surface", "particles"], endings: &["png"] };
/// USD files of resumed runs, numbered by their first frame.
pub const ANIMATED: Series = Series { folder: "", stems: &["surface", "particles"], endings: &["usda"] };
const CHECKPOINT_SERIES: Series =
    Series { folder: CHECKPOINTS, stems: &[CHECKPOINT], endings: &[Checkpoint::ENDING] };

/// All series.
pub const ALL: [Series; 5] = [PARTICLES, MESHES, PICTURES, ANIMATED, CHECKPOINT_SERIES];

impl Series {
    /// The files of this series below `root`, with their frame numbers.
    pub fn files(&self, root: &Path) -> impl Iterator<Item = (u32, PathBuf)> {
        let entries = fs::read_dir(root.join(self.folder)).into_iter().flatten().flatten();
        entries.filter_map(|entry| {
            let number = frame_number(&entry.file_name().to_string_lossy(), self.stems, self.endings)?;
            Some((number, root.join(self.folder).join(entry.file_name())))
        })
    }
}

/// The number in `stem_0123.ending`, which has at least four digits.
pub fn frame_number(name: &str, stems: &[&str], endings: &[&str]) -> Option<u32> {
    let number = |(stem, ending): (&str, &str)| {
        let digits = name.strip_prefix(stem)?.strip_prefix('_')?.strip_suffix(ending)?.strip_suffix('.')?;
        let all = digits.len() >= 4 && digits.bytes().all(|digit| digit.is_ascii_digit());
        digits.parse().ok().filter(|_| all)
    };
    stems.iter().find_map(|&stem| endings.iter().find_map(|&ending| number((stem, ending))))
}

#[cfg(test)]
mod tests {
    use super::frame_number;

    #[test]
    fn only_names_of_a_run_have_a_frame_number() {
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
}
