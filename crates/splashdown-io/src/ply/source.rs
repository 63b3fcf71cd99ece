//! A file that is read once from front to back, by lines or by runs of bytes.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use crate::error::IoError;
use crate::input::regular;

/// Bytes that are read at a time.
const BLOCK: usize = 1 << 18;

/// The longest line. A longer one means that the file is not text.
const LONGEST_LINE: usize = 1 << 20;

pub(super) struct Source {
    file: File,
    /// Bytes in `start..end` were read from the file, but not yet taken.
    buffer: Vec<u8>,
    start: usize,
    end: usize,
    /// Bytes of the file that were not read yet.
    unread: u64,
    lines: usize,
}

impl Source {
    pub(super) fn open(path: &Path) -> Result<Self, IoError> {
        regular(path)?;
        let failed = |error| IoError::read(path, &error);
        let file = File::open(path).map_err(failed)?;
        let unread = file.metadata().map_err(failed)?.len();
        Ok(Self { file, buffer: Vec::new(), start: 0, end: 0, unread, lines: 0 })
    }

    /// Bytes that were not taken yet.
    pub(super) fn left(&self) -> u64 {
        (self.end - self.start) as u64 + self.unread
    }

    /// Number of the line that was taken last, from 1.
    pub(super) fn line_number(&self) -> usize {
        self.lines
    }

    /// Takes the next line without its line feed; `None` at the end of the file.
    pub(super) fn line(&mut self) -> Result<Option<&[u8]>, String> {
        let mut searched = 0;
        let length = loop {
            let found = self.buffer[self.start + searched..self.end].iter().position(|&byte| byte == b'\n');
            if let Some(at) = found {
                break searched + at;
            }
            searched = self.end - self.start;
            if searched > LONGEST_LINE {
                return Err(format!("line {} has more than {LONGEST_LINE} bytes", self.lines + 1));
            }
            if !self.fill(searched + 1, 2 * searched)? {
                if searched == 0 {
                    return Ok(None);
                }
                break searched;
            }
        };
        self.lines += 1;
        let line = self.start..self.start + length;
        self.start = self.end.min(line.end + 1);
        Ok(Some(&self.buffer[line]))
    }

    /// Takes the next `count` bytes.
    pub(super) fn take(&mut self, count: usize) -> Result<&[u8], String> {
        if self.end - self.start < count && (count as u64 > self.left() || !self.fill(count, count)?) {
            return Err(format!("{count} bytes are needed, {} are left: it was cut short", self.left()));
        }
        let bytes = &self.buffer[self.start..self.start + count];
        self.start += count;
        Ok(bytes)
    }

    /// Discards the next `count` bytes.
    pub(super) fn skip(&mut self, mut count: u64) -> Result<(), String> {
        while count > 0 {
            let piece = count.min(BLOCK as u64);
            self.take(piece as usize)?;
            count -= piece;
        }
        Ok(())
    }

    /// Reads until the buffer contains `count` bytes, up to its capacity; false if the file ends before that.
    fn fill(&mut self, count: usize, capacity: usize) -> Result<bool, String> {
        self.buffer.copy_within(self.start..self.end, 0);
        self.end -= self.start;
        self.start = 0;
        let capacity = capacity.max(BLOCK);
        if self.buffer.len() < capacity {
            self.buffer.resize(capacity, 0);
        }
        while self.end < count {
            match self.file.read(&mut self.buffer[self.end..]) {
                // The file may have become shorter since its size was read.
                Ok(0) => self.unread = 0,
                Ok(read) => {
                    self.end += read;
                    self.unread = self.unread.saturating_sub(read as u64);
                    continue;
                }
                Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
                Err(error) => return Err(format!("reading failed: {error}")),
            }
            return Ok(false);
        }
        Ok(true)
    }
}
