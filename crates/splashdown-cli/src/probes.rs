//! What the scene's probes measure, each in a file of its own that grows while the simulation runs.

use std::fs;

use splashdown::scene::{Probe, Scene};
use splashdown::{Frame, probes};
use splashdown_io::{CsvLog, IoError, WrittenFile};

use crate::layout::Layout;

/// One file per probe, in the order of the scene.
#[derive(Debug, Default)]
pub struct ProbeFiles {
    logs: Vec<CsvLog>,
}

impl ProbeFiles {
    /// Begins the files with the names of their columns.
    ///
    /// # Errors
    /// [`IoError::Write`].
    pub fn create(scene: &Scene, layout: &Layout) -> Result<Self, IoError> {
        let create = |probe: &Probe| CsvLog::create(&layout.probe(&probe.name), probes::columns(probe));
        Ok(Self { logs: scene.probes.iter().map(create).collect::<Result<_, _>>()? })
    }

    /// Goes on with files that held this many bytes each.
    ///
    /// # Errors
    /// [`IoError::Write`].
    pub fn resume(scene: &Scene, layout: &Layout, bytes: &[u64]) -> Result<Self, IoError> {
        let resume = |(index, probe): (usize, &Probe)| {
            let path = layout.probe(&probe.name);
            match bytes.get(index) {
                Some(&bytes) => CsvLog::resume(&path, probes::columns(probe), bytes),
                None => CsvLog::create(&path, probes::columns(probe)),
            }
        };
        Ok(Self { logs: scene.probes.iter().enumerate().map(resume).collect::<Result<_, _>>()? })
    }

    /// Bytes in each file.
    pub fn bytes(&self) -> Vec<u64> {
        self.logs.iter().map(CsvLog::bytes).collect()
    }

    /// Appends what was measured up to a frame.
    ///
    /// # Errors
    /// [`IoError::Write`]; the rows before stay whole.
    pub fn write(&mut self, frame: &Frame) -> Result<(), IoError> {
        for (log, rows) in self.logs.iter_mut().zip(frame.probes.iter()) {
            for row in rows {
                log.row(row)?;
            }
        }
        Ok(())
    }

    /// The files as they are now.
    pub fn finish(self) -> Vec<WrittenFile> {
        let file = |log: &CsvLog| {
            let bytes = fs::metadata(log.path()).map_or(0, |data| data.len());
            WrittenFile { path: log.path().to_owned(), bytes }
        };
        self.logs.iter().map(file).collect()
    }
}
