//! CSV: a table of numbers that grows while a simulation runs, one line of column names, then one line per row.
//!
//! Unlike the other writers this one does not wait until the file is complete: a row is completely in the file when
//! [`CsvLog::row`] returns, so that a plot or `tail -f` can follow the run. Names are quoted where RFC 4180 requires it
//! (by the crate `csv`). Numbers have the fewest digits from which the same f64 is read. NaN, which a probe reports
//! where there is no water, is an empty field, which spreadsheets and `pandas` read as a missing value.

use std::fs::File;
use std::io::{self, Read as _, Seek, SeekFrom, Write as _};
use std::path::{Path, PathBuf};

use crate::atomic::sync_file;
use crate::error::IoError;

/// A CSV file that rows are appended to.
#[derive(Debug)]
pub struct CsvLog {
    path: PathBuf,
    file: File,
    columns: usize,
    /// Bytes of the header and all complete rows.
    length: u64,
}

impl CsvLog {
    /// Creates a file with a name for each column, e.g. `time (s)`. An existing file is replaced.
    ///
    /// # Errors
    /// [`IoError::Write`].
    pub fn create(path: &Path, columns: &[&str]) -> Result<Self, IoError> {
        let file = File::create(path).map_err(|error| IoError::write(path, &error))?;
        let mut log = Self { path: path.to_owned(), file, columns: columns.len(), length: 0 };
        log.append(columns)?;
        Ok(log)
    }

    /// Continues a file that had `bytes` bytes at the time from which a run is resumed. Rows written later are removed. A
    /// shorter file keeps its complete rows; a missing one, or one without a complete header, is created anew.
    ///
    /// # Errors
    /// [`IoError::Write`].
    pub fn resume(path: &Path, columns: &[&str], bytes: u64) -> Result<Self, IoError> {
        let Some(length) = complete_rows(path, bytes).filter(|&length| length > 0) else {
            return Self::create(path, columns);
        };
        let open = || {
            let mut file = File::options().write(true).open(path)?;
            file.set_len(length)?;
            file.seek(SeekFrom::End(0))?;
            Ok(file)
        };
        let file = open().map_err(|error| IoError::write(path, &error))?;
        Ok(Self { path: path.to_owned(), file, columns: columns.len(), length })
    }

    /// Bytes of the header and all complete rows.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.length
    }

    /// Appends one row, a number for each column. If it cannot be written completely, no part of it remains in the file,
    /// and writing a later row may be attempted.
    ///
    /// # Errors
    /// [`IoError::Columns`] if there is not one number for each column; [`IoError::Write`], for example if the disk is
    /// full.
    pub fn row(&mut self, values: &[f64]) -> Result<(), IoError> {
        if values.len() != self.columns {
            let (given, expected) = (values.len(), self.columns);
            return Err(IoError::Columns { path: self.path.clone(), given, expected });
        }
        self.append(values.iter().map(|&value| field(value)))
    }

    /// Flushes the rows to the disk, unless [`set_sync`](crate::atomic::set_sync) has turned this off.
    ///
    /// # Errors
    /// [`IoError::Write`].
    pub fn sync(&self) -> Result<(), IoError> {
        sync_file(&self.file).map_err(|error| IoError::write(&self.path, &error))
    }

    /// The file's path as it was given.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Writes a line with a single call to the system.
    fn append(&mut self, fields: impl IntoIterator<Item: AsRef<[u8]>>) -> Result<(), IoError> {
        let result = line(fields).and_then(|line| self.file.write_all(&line).map(|()| line.len() as u64));
        match result {
            Ok(size) => self.length += size,
            Err(error) => {
                // An incomplete row would be read as wrong numbers, so it is removed. A failure to remove it is
                // ignored, because the failure to write is reported in any case.
                let _ = self.file.set_len(self.length);
                let _ = self.file.seek(SeekFrom::Start(self.length));
                return Err(IoError::write(&self.path, &error));
            }
        }
        Ok(())
    }
}

/// The bytes up to the end of the last complete row within the first `limit` bytes of a file; `None` if it cannot be read.
fn complete_rows(path: &Path, limit: u64) -> Option<u64> {
    let mut file = File::open(path).ok()?;
    let mut end = file.metadata().ok()?.len().min(limit);
    let mut chunk = [0; 4096];
    while end > 0 {
        let length = end.min(chunk.len() as u64);
        file.seek(SeekFrom::Start(end - length)).ok()?;
        let part = &mut chunk[..length as usize];
        file.read_exact(part).ok()?;
        if let Some(at) = part.iter().rposition(|&byte| byte == b'\n') {
            return Some(end - length + at as u64 + 1);
        }
        end -= length;
    }
    Some(0)
}

fn line(fields: impl IntoIterator<Item: AsRef<[u8]>>) -> io::Result<Vec<u8>> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(fields)?;
    writer.into_inner().map_err(csv::IntoInnerError::into_error)
}

fn field(value: f64) -> String {
    match value {
        _ if value.is_nan() => String::new(),
        f64::INFINITY => "inf".to_owned(),
        f64::NEG_INFINITY => "-inf".to_owned(),
        _ => zmij::Buffer::new().format_finite(value).to_owned(),
    }
}
