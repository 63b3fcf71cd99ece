//! The tables of the scene's probes and bodies: one CSV file each, extended after every frame.

use std::fs;
use std::path::PathBuf;

use splashdown::probes;
use splashdown::run::Frame;
use splashdown::scene::Scene;
use splashdown_io::{CsvLog, IoError, WrittenFile};

use crate::{Reporter, RunFolder, body_table};

/// The name of a table in messages, its file and its columns.
type Table = (&'static str, PathBuf, &'static [&'static str]);

/// The tables of a scene: those of the probes, then those of the bodies.
fn tables(scene: &Scene, folder: &RunFolder) -> Vec<Table> {
    let probes =
        scene.probes.iter().map(|probe| ("probe table", folder.probe(&probe.name), probes::columns(probe)));
    let bodies =
        scene.bodies.iter().map(|body| ("body table", folder.body(&body.name), &body_table::COLUMNS[..]));
    probes.chain(bodies).collect()
}

/// One file per probe and per body.
#[derive(Debug, Default)]
pub(crate) struct Tables {
    logs: Vec<CsvLog>,
}

impl Tables {
    /// Creates the files and writes the names of their columns.
    ///
    /// # Errors
    /// [`IoError::Write`].
    pub fn create(scene: &Scene, folder: &RunFolder) -> Result<Self, IoError> {
        let create = |(_, path, columns): Table| CsvLog::create(&path, columns);
        Ok(Self { logs: tables(scene, folder).into_iter().map(create).collect::<Result<_, _>>()? })
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
        let resume = |(index, (what, path, columns)): (usize, Table)| {
            let Some(&bytes) = bytes.get(index) else { return CsvLog::create(&path, columns) };
            let given = fs::metadata(&path).map(|data| data.len());
            let (file, rest) = (path.display(), "the rows up to the checkpoint are incomplete");
            match given {
                Ok(given) if given < bytes => reporter.warning(&format!(
                    "the {what} `{file}` has {given} of the {bytes} bytes that it had at the checkpoint; {rest}"
                )),
                Err(error) => reporter.warning(&format!("cannot read the {what} `{file}` ({error}); {rest}")),
                Ok(_) => {}
            }
            CsvLog::resume(&path, columns, bytes)
        };
        let logs = tables(scene, folder).into_iter().enumerate().map(resume).collect::<Result<_, _>>()?;
        Ok(Self { logs })
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

    /// Appends the samples of the probes up to a frame, and the states of the bodies.
    ///
    /// # Errors
    /// [`IoError::Write`]; earlier rows stay complete.
    pub fn write(&mut self, frame: &Frame) -> Result<(), IoError> {
        let (probes, bodies) = self.logs.split_at_mut(frame.probes.len());
        for (log, rows) in probes.iter_mut().zip(frame.probes.iter()) {
            for row in rows {
                log.row(row)?;
            }
        }
        for (log, state) in bodies.iter_mut().zip(frame.bodies.iter()) {
            log.row(&body_table::row(frame.time, state))?;
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
