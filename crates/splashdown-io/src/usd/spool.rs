//! The file with the samples of one attribute, one line per frame.

use std::fs::{self, File};
use std::io::{self, BufRead, BufReader, BufWriter, Read, Seek, Write};
use std::path::{Path, PathBuf};

use super::text::Text;
use crate::atomic::{Temporary, sync_file};

/// The declaration of an attribute.
#[derive(Debug)]
pub(super) struct Attribute {
    /// Type and name.
    pub(super) declaration: &'static str,
    /// The kind of element to which each value belongs, if the kind of the prim does not imply it.
    pub(super) interpolation: Option<&'static str>,
}

impl Attribute {
    /// The name without type and namespace.
    fn name(&self) -> &'static str {
        self.declaration.rsplit([' ', ':']).next().unwrap_or_default()
    }
}

/// The samples of an attribute.
#[derive(Debug)]
pub(super) struct Spool {
    attribute: &'static Attribute,
    file: BufWriter<File>,
    /// Removes the file on drop, if it is temporary.
    _temporary: Option<Temporary>,
    /// Whether any frame has values.
    used: bool,
}

impl Spool {
    /// Starts a file that disappears with the process.
    pub(super) fn temporary(path: &Path, attribute: &'static Attribute) -> io::Result<Self> {
        let temporary = Temporary::create(path)?;
        let file = BufWriter::new(temporary.file().try_clone()?);
        Ok(Self { attribute, file, _temporary: Some(temporary), used: false })
    }

    /// Starts a file that remains until it is removed. An existing one is replaced.
    pub(super) fn kept(path: &Path, attribute: &'static Attribute) -> io::Result<Self> {
        let file = File::options().read(true).write(true).create(true).truncate(true).open(path)?;
        Ok(Self { attribute, file: BufWriter::new(file), _temporary: None, used: false })
    }

    /// Continues a kept file after the frame `last`. Later frames are removed. Also returns the numbers of the frames.
    pub(super) fn continued(
        path: &Path,
        attribute: &'static Attribute,
        last: u32,
    ) -> io::Result<(Self, Vec<u32>)> {
        let mut file = File::options().read(true).write(true).open(path)?;
        let (mut frames, mut end, mut used) = (Vec::new(), 0, false);
        let mut reader = BufReader::with_capacity(1 << 16, &mut file);
        while let Some(line) = Line::read(&mut reader, &mut io::sink())? {
            match line {
                Line { frame: Some(frame), is_complete: true, .. } if frame <= last => {
                    frames.push(frame);
                    end += line.bytes;
                    used |= line.has_values;
                }
                _ => break,
            }
        }
        file.set_len(end)?;
        file.seek(io::SeekFrom::Start(end))?;
        Ok((Self { attribute, file: BufWriter::new(file), _temporary: None, used }, frames))
    }

    /// The path of a kept file: in this folder, with the name of the series and of the attribute.
    pub(super) fn path(folder: &Path, series: &str, attribute: &Attribute) -> PathBuf {
        folder.join(format!("{series}_{}.{}", attribute.name(), super::PART_ENDING))
    }

    /// Passes the data to the system, so that it survives the process.
    pub(super) fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }

    /// Flushes the data to the disk.
    pub(super) fn sync(&mut self) -> io::Result<()> {
        self.flush()?;
        sync_file(self.file.get_ref())
    }

    /// Copies a line of samples from `from`, up to a frame; returns the frame's number if the line was copied.
    pub(super) fn copy_line(&mut self, from: &mut impl BufRead, last: u32) -> io::Result<Option<u32>> {
        let before = self.file.stream_position()?;
        let line = Line::read(from, &mut self.file)?;
        match line {
            Some(Line { frame: Some(frame), is_complete: true, has_values, .. }) if frame <= last => {
                self.used |= has_values;
                Ok(Some(frame))
            }
            _ => {
                self.file.seek(io::SeekFrom::Start(before))?;
                let file = self.file.get_ref();
                file.set_len(before)?;
                Ok(None)
            }
        }
    }

    pub(super) fn vectors(&mut self, frame: u32, values: &[[f32; 3]], used: bool) -> io::Result<()> {
        self.sample(frame, used, |text| {
            for &[x, y, z] in values {
                text.vector([x, y, z])?;
            }
            Ok(())
        })
    }

    pub(super) fn numbers(&mut self, frame: u32, values: &[f32], used: bool) -> io::Result<()> {
        self.sample(frame, used, |text| values.iter().try_for_each(|&value| text.number(value)))
    }

    pub(super) fn integers(
        &mut self,
        frame: u32,
        mut values: impl Iterator<Item = u32>,
        used: bool,
    ) -> io::Result<()> {
        self.sample(frame, used, |text| values.try_for_each(|value| text.integer(value)))
    }

    fn sample(
        &mut self,
        frame: u32,
        used: bool,
        fill: impl FnOnce(&mut Text<'_>) -> io::Result<()>,
    ) -> io::Result<()> {
        self.used |= used;
        write!(self.file, "{INDENT}{frame}: [")?;
        let mut text = Text::new(&mut self.file);
        fill(&mut text)?;
        text.finish()?;
        writeln!(self.file, "],")
    }

    /// Appends the sample of a frame without values.
    pub(super) fn empty(&mut self, frame: u32) -> io::Result<()> {
        self.sample(frame, false, |_| Ok(()))
    }

    /// Writes the attribute if any frame has it.
    pub(super) fn write_to(&mut self, out: &mut dyn Write) -> io::Result<()> {
        self.flush()?;
        if !self.used {
            return Ok(());
        }
        let mut file = self.file.get_ref();
        let Attribute { declaration, interpolation } = self.attribute;
        if let Some(word) = interpolation {
            writeln!(out, "        {declaration} (\n            interpolation = \"{word}\"\n        )")?;
        }
        writeln!(out, "        {declaration}.timeSamples = {{")?;
        file.rewind()?;
        io::copy(&mut file, out)?;
        writeln!(out, "        }}")
    }
}

/// A line `            12: [...],`, as [`Spool::sample`] writes it.
struct Line {
    bytes: u64,
    frame: Option<u32>,
    has_values: bool,
    /// Whether it ends as a sample does. The last line of a killed run does not.
    is_complete: bool,
}

impl Line {
    /// Reads a line and copies it, without holding it in memory. `None` at the end of the file.
    fn read(from: &mut impl BufRead, to: &mut impl Write) -> io::Result<Option<Self>> {
        let (mut head, mut tail) = (Vec::new(), Vec::new());
        let mut bytes = 0;
        loop {
            let chunk = from.fill_buf()?;
            let length = chunk.iter().position(|&byte| byte == b'\n').map_or(chunk.len(), |at| at + 1);
            let chunk = &chunk[..length];
            to.write_all(chunk)?;
            head.extend(chunk.iter().take(HEAD.saturating_sub(head.len())));
            tail.extend_from_slice(&chunk[length.saturating_sub(TAIL.len())..]);
            tail.drain(..tail.len().saturating_sub(TAIL.len()));
            bytes += length as u64;
            let ended = length == 0 || tail.ends_with(b"\n");
            from.consume(length);
            if ended {
                break;
            }
        }
        if bytes == 0 {
            return Ok(None);
        }
        let text = String::from_utf8_lossy(&head);
        let sample = text.strip_prefix(INDENT).and_then(|rest| rest.split_once(": ["));
        let frame = sample.and_then(|(number, _)| number.parse().ok());
        let has_values = sample.is_some_and(|(_, values)| !values.starts_with(']'));
        Ok(Some(Self { bytes, frame, has_values, is_complete: tail == TAIL }))
    }
}

/// Bytes that contain the beginning of a line up to its first value.
const HEAD: usize = 40;
/// The indentation of samples.
const INDENT: &str = "            ";
/// The end of a sample.
const TAIL: &[u8] = b"],\n";

/// Removes kept files. One that cannot be removed is replaced by the next run.
pub(super) fn remove(paths: &[PathBuf]) {
    for path in paths {
        let _ = fs::remove_file(path);
    }
}

/// The position of the first line of samples of an attribute.
pub(super) fn is_head(line: &str, attribute: &Attribute) -> bool {
    line.trim_end().strip_prefix("        ").and_then(|line| line.strip_suffix(".timeSamples = {"))
        == Some(attribute.declaration)
}

/// Reads one line of at most `limit` bytes.
pub(super) fn short_line(from: &mut impl BufRead, limit: u64) -> io::Result<Option<String>> {
    let mut line = Vec::new();
    from.take(limit).read_until(b'\n', &mut line)?;
    Ok((!line.is_empty()).then(|| String::from_utf8_lossy(&line).into_owned()))
}
