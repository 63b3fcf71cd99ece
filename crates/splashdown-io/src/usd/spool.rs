//! The temporary file with the samples of one attribute.

use std::fs::File;
use std::io::{self, BufWriter, Seek, Write};
use std::path::Path;

use super::text::Text;
use crate::atomic::Temporary;

/// The declaration of an attribute.
#[derive(Debug)]
pub(super) struct Attribute {
    /// Type and name.
    pub(super) declaration: &'static str,
    /// The kind of element to which each value belongs, if the kind of the prim does not imply it.
    pub(super) interpolation: Option<&'static str>,
}

/// A hidden file with the samples of an attribute, removed on drop.
#[derive(Debug)]
pub(super) struct Spool {
    attribute: &'static Attribute,
    file: BufWriter<File>,
    /// Removes the file on drop.
    _temporary: Temporary,
    /// Whether any frame has values.
    used: bool,
}

impl Spool {
    pub(super) fn create(path: &Path, attribute: &'static Attribute) -> io::Result<Self> {
        let temporary = Temporary::beside(path);
        let file = BufWriter::new(temporary.create()?);
        Ok(Self { attribute, file, _temporary: temporary, used: false })
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
        write!(self.file, "            {frame}: [")?;
        let mut text = Text::new(&mut self.file);
        fill(&mut text)?;
        text.finish()?;
        writeln!(self.file, "],")
    }

    /// Writes the attribute if any frame has it.
    pub(super) fn write_to(self, out: &mut dyn Write) -> io::Result<()> {
        let mut file = self.file.into_inner().map_err(io::IntoInnerError::into_error)?;
        if !self.used {
            return Ok(());
        }
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
