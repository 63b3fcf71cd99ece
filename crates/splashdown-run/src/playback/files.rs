//! The files of the frames in a folder.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use splashdown::foam::DiffuseKind;
use splashdown_io::Format;

use crate::folder::{DROPLET_SERIES, MESHES, PARTICLES};

/// The files of a frame that can be read, in several formats.
#[derive(Debug, Default)]
pub struct FilesOfFrame {
    pub particles: Vec<PathBuf>,
    pub meshes: Vec<PathBuf>,
    pub droplets: Vec<PathBuf>,
    /// In the order of [`DiffuseKind::ALL`].
    pub diffuse: [Vec<PathBuf>; 3],
}

/// The files by the numbers of their frames.
#[derive(Debug)]
pub struct FileIndex(BTreeMap<u32, FilesOfFrame>);

impl FileIndex {
    pub fn of(folder: &Path) -> Self {
        let mut frames: BTreeMap<u32, FilesOfFrame> = BTreeMap::new();
        let reads = |path: &Path, condition: fn(&Format) -> bool| Format::of(path).is_some_and(condition);
        for (number, path) in MESHES.files(folder).filter(|(_, path)| reads(path, Format::reads_meshes)) {
            frames.entry(number).or_default().meshes.push(path);
        }
        for (number, path) in PARTICLES.files(folder).filter(|(_, path)| reads(path, Format::reads_particles))
        {
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            let kind = DiffuseKind::ALL.iter().position(|(_, kind)| name.starts_with(kind));
            let frame = frames.entry(number).or_default();
            match kind {
                Some(kind) => frame.diffuse[kind].push(path),
                None => frame.particles.push(path),
            }
        }
        for (number, path) in
            DROPLET_SERIES.files(folder).filter(|(_, path)| reads(path, Format::reads_particles))
        {
            frames.entry(number).or_default().droplets.push(path);
        }
        // Foam and droplets alone are not a frame.
        frames.retain(|_, files| !(files.particles.is_empty() && files.meshes.is_empty()));
        for files in frames.values_mut() {
            files.particles.sort();
            files.meshes.sort();
        }
        Self(frames)
    }

    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    pub fn numbers(&self) -> impl Iterator<Item = u32> + Clone {
        self.0.keys().copied()
    }

    pub fn files(&self, number: u32) -> Option<&FilesOfFrame> {
        self.0.get(&number)
    }

    pub fn has_particles_and_meshes(&self) -> (bool, bool) {
        let any = |has: fn(&FilesOfFrame) -> bool| self.0.values().any(has);
        (any(|files| !files.particles.is_empty()), any(|files| !files.meshes.is_empty()))
    }

    /// Frames without any file of spray, foam or bubbles, in words; `None` if there are none.
    pub fn without_foam(&self, wanted: impl Fn(u32) -> bool) -> Option<String> {
        let lacks = |(number, files): &(&u32, &FilesOfFrame)| {
            wanted(**number) && files.diffuse.iter().all(Vec::is_empty)
        };
        let ranges = ranges(self.0.iter().filter(lacks).map(|(number, _)| *number));
        (!ranges.is_empty()).then(|| format!("{} without files of spray, foam and bubbles", listed(&ranges)))
    }

    /// Missing numbers, and frames without particles or a mesh where others have them.
    pub fn problems(&self) -> Vec<String> {
        let (particles, meshes) = self.has_particles_and_meshes();
        let without = |has: fn(&FilesOfFrame) -> bool| {
            ranges(self.0.iter().filter(|(_, files)| !has(files)).map(|(number, _)| *number))
        };
        // Gaps between successive numbers, which may be far apart.
        let pairs = self.numbers().zip(self.numbers().skip(1));
        let missing = pairs.filter(|(a, b)| b - a > 1).map(|(a, b)| (a + 1, b - 1)).collect();
        let mut problems = Vec::new();
        let mut report = |ranges: Vec<(u32, u32)>, what: &str| {
            if !ranges.is_empty() {
                problems.push(format!("{} {what}", listed(&ranges)));
            }
        };
        report(missing, "missing");
        if particles {
            report(without(|files| !files.particles.is_empty()), "without particles");
        }
        if meshes {
            report(without(|files| !files.meshes.is_empty()), "without a mesh");
        }
        problems
    }
}

/// The first and last numbers of the ranges in ascending numbers.
pub fn ranges(numbers: impl Iterator<Item = u32>) -> Vec<(u32, u32)> {
    let mut ranges: Vec<(u32, u32)> = Vec::new();
    for number in numbers {
        match ranges.last_mut() {
            Some((_, last)) if number - *last == 1 => *last = number,
            _ => ranges.push((number, number)),
        }
    }
    ranges
}

/// Numbers of frames in words, such as `frames 3, 7 to 9`.
pub fn listed(ranges: &[(u32, u32)]) -> String {
    let shown = ranges.iter().take(4).map(|&(first, last)| match last - first {
        0 => first.to_string(),
        _ => format!("{first} to {last}"),
    });
    let mut text = shown.collect::<Vec<_>>().join(", ");
    if ranges.len() > 4 {
        text.push_str(", ...");
    }
    let is_one = ranges.len() == 1 && ranges[0].0 == ranges[0].1;
    format!("{} {text}", if is_one { "frame" } else { "frames" })
}

#[cfg(test)]
mod tests {
    use super::{listed, ranges};

    #[test]
    fn successive_numbers_are_a_range() {
        let words = |numbers: &[u32]| listed(&ranges(numbers.iter().copied()));
        assert_eq!(words(&[3]), "frame 3");
        assert_eq!(words(&[3, 7, 8, 9]), "frames 3, 7 to 9");
        assert_eq!(words(&[1, 3, 5, 7, 9]), "frames 1, 3, 5, 7, ...");
        assert_eq!(words(&[u32::MAX - 1, u32::MAX]), "frames 4294967294 to 4294967295");
    }
}
