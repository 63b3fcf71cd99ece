//! CSV, a table of numbers that grows while a simulation runs: one line of names, then one line a row.
//!
//! Unlike the other writers this one does not wait until the file is complete: a row is in the file when
//! [`CsvLog::row`] returns, whole, so that a plot or a `tail -f` can follow the run. Names are quoted where they must
//! be (RFC 4180); numbers have the fewest digits that give the same f64 back; NaN, which is how a probe tells that it
//! saw no water, is an empty field, as spreadsheets and `pandas` read it.

use std::fs::File;
use std::io::{Seek, SeekFrom, Write as _};
use std::path::{Path, PathBuf};

use crate::error::IoError;

/// A CSV file that rows are appended to.
#[derive(Debug)]
pub struct CsvLog {
    path: PathBuf,
    file: File,
    columns: usize,
    /// Bytes of the header and all whole rows.
    length: u64,
    line: Vec<u8>,
}

impl CsvLog {
    /// Begins a file with a name for each column, e.g. `time (s)`. A file that was there before is replaced.
    ///
    /// # Errors
    /// [`IoError::Write`].
    pub fn create(path: &Path, columns: &[&str]) -> Result<Self, IoError> {
        let file = File::create(path).map_err(|error| IoError::write(path, &error))?;
        let mut log =
            Self { path: path.to_owned(), file, columns: columns.len(), length: 0, line: Vec::new() };
        for (number, name) in columns.iter().enumerate() {
            log.separate(number);
            if name.contains([',', '"', '\n', '\r']) {
                log.line.extend(format!("\"{}\"", name.replace('"', "\"\"")).bytes());
            } else {
                log.line.extend(name.bytes());
            }
        }
        log.append()?;
        Ok(log)
    }

    /// Goes on with a file that held `bytes` bytes at a moment to return to: what came later is cut off. A file
    /// that is gone or shorter begins anew.
    ///
    /// # Errors
    /// [`IoError::Write`].
    pub fn resume(path: &Path, columns: &[&str], bytes: u64) -> Result<Self, IoError> {
        let there = std::fs::metadata(path).is_ok_and(|data| data.len() >= bytes && bytes > 0);
        if !there {
            return Self::create(path, columns);
        }
        let open = || {
            let mut file = File::options().write(true).open(path)?;
            file.set_len(bytes)?;
            file.seek(SeekFrom::End(0))?;
            Ok(file)
        };
        let file = open().map_err(|error| IoError::write(path, &error))?;
        Ok(Self { path: path.to_owned(), file, columns: columns.len(), length: bytes, line: Vec::new() })
    }

    /// Bytes of the header and all whole rows.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.length
    }

    /// Appends one row, a number for each column. If it cannot be written whole, nothing of it stays, and a later row
    /// may be tried.
    ///
    /// # Errors
    /// [`IoError::Columns`] where there are more or fewer numbers than columns; [`IoError::Write`], a full disk among
    /// others.
    pub fn row(&mut self, values: &[f64]) -> Result<(), IoError> {
        if values.len() != self.columns {
            let (given, expected) = (values.len(), self.columns);
            return Err(IoError::Columns { path: self.path.clone(), given, expected });
        }
        for (number, &value) in values.iter().enumerate() {
            self.separate(number);
            if value.is_finite() {
                self.line.extend(zmij::Buffer::new().format(value).bytes());
            } else if value.is_infinite() {
                self.line.extend(if value > 0.0 { "inf" } else { "-inf" }.bytes());
            } else if self.columns == 1 {
                // A line without anything would be no row at all.
                self.line.extend(b"\"\"");
            }
        }
        self.append()
    }

    /// The file's path as it was given.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    fn separate(&mut self, number: usize) {
        if number > 0 {
            self.line.push(b',');
        }
    }

    /// Ends the line and hands it to the system in one piece.
    fn append(&mut self) -> Result<(), IoError> {
        self.line.push(b'\n');
        let result = self.file.write_all(&self.line);
        let size = self.line.len() as u64;
        self.line.clear();
        match result {
            Ok(()) => self.length += size,
            Err(error) => {
                // Half a row would be read as a wrong number. Failing at this too changes nothing about the report.
                let _ = self.file.set_len(self.length);
                let _ = self.file.seek(SeekFrom::Start(self.length));
                return Err(IoError::write(&self.path, &error));
            }
        }
        Ok(())
    }
}
