//! The tables of the scene's probes: one CSV file each, extended after every frame.

use std::fs;

use splashdown::probes;
use splashdown::run::Frame;
use splashdown::scene::{Probe, Scene};
use splashdown_io::{CsvLog, IoError, WrittenFile};

use crate::{Reporter, RunFolder};

/// One file per probe, in the order of the scene.
#[derive(Debug, Default)]
pub(crate) struct ProbeFiles {
    logs: Vec<CsvLog>,
}

impl ProbeFiles {
    /// Creates the files and writes the names of their columns.
    ///
    /// # Errors
    /// [`IoError::Write`].
    pub fn create(scene: &Scene, folder: &RunFolder) -> Result<Self, IoError> {
        let create = |probe: &Probe| CsvLog::create(&folder.probe(&probe.name), probes::columns(probe));
        Ok(Self { logs: scene.probes.iter().map(create).collect::<Result<_, _>>()? })
    }

    /// Continues existing files. Each is first truncated to its number of bytes at the checkpoint. Tables that are
    /// missing or shorter are reported; a shorter one keeps its complete rows.
    ///
    /// # Errors
    /// [`IoError::Write`].
    pub fn resume(
        scene: &Scene,
        folder: &RunFolder,
        bytes: &[u64],
        reporter: &mut dyn Reporter,
    ) -> Result<Self, IoError> {
        let resume = |(index, probe): (usize, &Probe)| {
            let path = folder.probe(&probe.name);
            match bytes.get(index) {
                Some(&bytes) => {
                    let given = fs::metadata(&path).map(|data| data.len());
                    let (file, rest) = (path.display(), "the rows up to the checkpoint are incomplete");
                    match given {
                        Ok(given) if given < bytes => reporter.warning(&format!(
                            "the probe table `{file}` has {given} of the {bytes} bytes that it had at the checkpoint; {rest}"
                        )),
                        Err(error) => reporter.warning(&format!("cannot read the probe table `{file}` ({error}); {rest}")),
                        Ok(_) => {}
                    }
                    CsvLog::resume(&path, probes::columns(probe), bytes)
                }
                None => CsvLog::create(&path, probes::columns(probe)),
            }
        };
        Ok(Self { logs: scene.probes.iter().enumerate().map(resume).collect::<Result<_, _>>()? })
    }

    /// Flushes the files to the disk.
    ///
    /// # Errors
    /// [`IoError::Write`].
    pub fn sync(&self) -> Result<(), IoError> {
        self.logs.iter().try_for_each(CsvLog::sync)
    }

    /// Bytes in each file.
    pub fn bytes(&self) -> Vec<u64> {
        self.logs.iter().map(CsvLog::bytes).collect()
    }

    /// Appends the samples up to a frame.
    ///
    /// # Errors
    /// [`IoError::Write`]; earlier rows stay complete.
    pub fn write(&mut self, frame: &Frame) -> Result<(), IoError> {
        for (log, rows) in self.logs.iter_mut().zip(frame.probes.iter()) {
            for row in rows {
                log.row(row)?;
            }
        }
        Ok(())
    }

    /// The files with their sizes.
    pub fn finish(self) -> Vec<WrittenFile> {
        let file = |log: &CsvLog| {
            // The run ends in any case, and its rows are in the file.
            let _ = log.sync();
            let bytes = fs::metadata(log.path()).map_or(0, |data| data.len());
            WrittenFile { path: log.path().to_owned(), bytes }
        };
        self.logs.iter().map(file).collect()
    }
}
