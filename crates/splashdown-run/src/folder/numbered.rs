//! The numbered files of a run.

use std::fs;
use std::path::{Path, PathBuf};

use splashdown::Checkpoint;
use splashdown_io::Format;

/// The folder of the checkpoints.
pub const CHECKPOINTS: &str = "checkpoints";
/// The stem of the names of droplets, and their folder.
pub const DROPLETS: &str = "droplets";
/// The stem of the names of particles.
pub const PARTICLES_STEM: &str = "particles";
/// The stem of the names of meshes of the surface.
pub const SURFACE: &str = "surface";
/// The stem of the names of checkpoints.
pub const CHECKPOINT: &str = "checkpoint";

/// Files `STEM_NUMBER.ENDING` in a folder below the root.
#[derive(Clone, Copy, Debug)]
pub struct Series {
    pub folder: &'static str,
    pub stems: &'static [&'static str],
    /// Whether files of the series can have this ending, given without a dot.
    has_ending: fn(&str) -> bool,
}

pub const PARTICLES: Series = Series {
    folder: "particles",
    stems: &[PARTICLES_STEM, "spray", "foam", "bubbles"],
    has_ending: |ending| is_format(ending, |format| format.writes_particles() && !format.is_series()),
};
pub const MESHES: Series = Series {
    folder: "mesh",
    stems: &[SURFACE],
    has_ending: |ending| is_format(ending, |format| format.writes_meshes() && !format.is_series()),
};
/// Points in a format of meshes.
const DIFFUSE_POINTS: Series = Series {
    folder: "particles",
    stems: &["spray", "foam", "bubbles"],
    has_ending: |ending| ending == "glb",
};
pub const DROPLET_SERIES: Series = Series {
    folder: DROPLETS,
    stems: &[DROPLETS],
    has_ending: |ending| ending == "glb" || (PARTICLES.has_ending)(ending),
};
pub const PICTURES: Series =
    Series { folder: "pictures", stems: &["surface", "particles"], has_ending: |ending| ending == "png" };
/// The stem of the files with the whole scene and all frames.
pub const SCENE_FILE: &str = "scene";
/// Such files of resumed runs, numbered by their first frame.
pub const ANIMATED: Series = Series {
    folder: "",
    stems: &[SCENE_FILE, PARTICLES_STEM],
    has_ending: |ending| ending == "glb" || is_format(ending, Format::is_series),
};
const CHECKPOINT_SERIES: Series =
    Series { folder: CHECKPOINTS, stems: &[CHECKPOINT], has_ending: |ending| ending == Checkpoint::ENDING };

fn is_format(ending: &str, condition: fn(&Format) -> bool) -> bool {
    Format::with_ending(ending).is_some_and(condition)
}

/// All series.
pub const ALL: [Series; 7] =
    [PARTICLES, DIFFUSE_POINTS, DROPLET_SERIES, MESHES, PICTURES, ANIMATED, CHECKPOINT_SERIES];

impl Series {
    /// The files of this series below `root`, with their frame numbers.
    pub fn files(&self, root: &Path) -> impl Iterator<Item = (u32, PathBuf)> {
        let entries = fs::read_dir(root.join(self.folder)).into_iter().flatten().flatten();
        entries.filter_map(|entry| {
            let number = frame_number(&entry.file_name().to_string_lossy(), self.stems, self.has_ending)?;
            Some((number, root.join(self.folder).join(entry.file_name())))
        })
    }
}

/// The number in `stem_0123.ending`, which has at least four digits.
pub fn frame_number(name: &str, stems: &[&str], has_ending: fn(&str) -> bool) -> Option<u32> {
    let (name, _) = name.rsplit_once('.').filter(|(_, ending)| has_ending(ending))?;
    let digits = stems.iter().find_map(|stem| name.strip_prefix(stem)?.strip_prefix('_'))?;
    let is_number = digits.len() >= 4 && digits.bytes().all(|digit| digit.is_ascii_digit());
    digits.parse().ok().filter(|_| is_number)
}

#[cfg(test)]
mod tests {
    use super::{ALL, PARTICLES, frame_number};
    use splashdown_io::Format;

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
        let number = |name: &str| frame_number(name, &["particles"], PARTICLES.has_ending);
        assert!(yes.map(number) == [Some(0), Some(12_345)]);
        assert!(!no.iter().any(|name| number(name).is_some()));
    }

    #[test]
    fn every_written_format_has_a_series() {
        for format in Format::ALL.iter().filter(|format| format.writes_particles() || format.writes_meshes())
        {
            assert!(ALL.iter().any(|series| (series.has_ending)(&format.ending[1..])), "{}", format.name);
        }
        assert!(!ALL.iter().any(|series| (series.has_ending)("xyz")), "XYZ files are not written");
    }
}
