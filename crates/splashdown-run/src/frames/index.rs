//! ParaView's indices of the series of a run, which contain the times of the frames.

use std::path::PathBuf;

use splashdown::foam::DiffuseKind;
use splashdown::scene::{Format, Scene};
use splashdown_io::{IoError, pvd};

use super::CompleteFrame;
use crate::RunFolder;
use crate::folder::{DROPLETS, PARTICLES_STEM, SURFACE};

/// The index of the files of one kind, such as particles or foam.
#[derive(Debug)]
pub struct Index {
    folder: RunFolder,
    stem: &'static str,
    /// The format of the files. An index has files of one format only.
    format: Format,
    /// Times in s and file names.
    series: Vec<(f64, String)>,
}

impl Index {
    /// An empty index for each series of files that a scene writes in a format that an index can list. If there are
    /// several such formats, the index lists the files of the first.
    pub fn all(folder: &RunFolder, scene: &Scene) -> Vec<Self> {
        let first = |has: fn(Format) -> bool| {
            scene.output.formats.iter().copied().find(|&format| format.has_index() && has(format))
        };
        let points = [(PARTICLES_STEM, true), (DROPLETS, scene.surface.separates())].into_iter();
        let points = points.chain(DiffuseKind::ALL.map(|(_, name)| (name, scene.foam.enabled)));
        let points = points.map(|(stem, has)| (stem, has, first(Format::has_particles)));
        let surface = (SURFACE, scene.surface.enabled, first(Format::has_surface));
        let series = points.chain([surface]).filter(|(_, has, _)| *has);
        let index = |(stem, _, format): (_, bool, Option<Format>)| {
            Some(Self { folder: folder.clone(), stem, format: format?, series: Vec::new() })
        };
        series.filter_map(index).collect()
    }

    /// Adds the existing frames up to `last`.
    pub fn add_existing(&mut self, last: u32, frame_rate: f32) {
        for frame in 0..=last {
            let path = self.file(frame);
            if path.exists() {
                self.add(f64::from(frame) / f64::from(frame_rate), &path);
            }
        }
    }

    /// Adds these frames and writes the index, so that the series can be opened while it grows.
    ///
    /// # Errors
    /// [`IoError::Write`].
    pub fn extend(&mut self, frames: &[CompleteFrame]) -> Result<(), IoError> {
        let before = self.series.len();
        for frame in frames {
            let path = self.file(frame.summary.index);
            if frame.files.contains(&path) {
                self.add(frame.summary.stats.time, &path);
            }
        }
        match self.series.len() == before {
            true => Ok(()),
            false => pvd::write_index(&self.folder.index_of(self.stem), &self.series).map(|_| ()),
        }
    }

    fn file(&self, frame: u32) -> PathBuf {
        self.folder.file(self.stem, frame, self.format.ending())
    }

    fn add(&mut self, time: f64, path: &std::path::Path) {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        self.series.push((time, name));
    }
}
