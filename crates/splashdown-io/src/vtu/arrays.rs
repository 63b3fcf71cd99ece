//! Arrays of a file: declared in the XML, appended after it.

use std::io::{self, Write};

use bytemuck::NoUninit;

use crate::data::Attribute;

/// Generated numbers per write.
const CHUNK: usize = 4096;

/// An array with its name and number type.
pub(super) struct Array<'a> {
    pub(super) name: &'a str,
    pub(super) kind: &'static str,
    pub(super) components: u32,
    pub(super) data: Data<'a>,
}

/// The bytes of an array, or how to generate them, so that cell arrays need no memory.
pub(super) enum Data<'a> {
    Bytes(&'a [u8]),
    /// A single float64.
    Number(f64),
    /// Consecutive integers, as Int32.
    Range {
        first: i32,
        count: usize,
    },
    /// The end of each cell of as many corners, as Int64.
    Ends {
        corners: i64,
        count: usize,
    },
    /// The same number, as UInt8.
    Repeat {
        value: u8,
        count: usize,
    },
}

impl<'a> Array<'a> {
    pub(super) fn of<T: NoUninit>(
        name: &'a str,
        kind: &'static str,
        components: u32,
        values: &'a [T],
    ) -> Self {
        Self { name, kind, components, data: Data::Bytes(bytemuck::cast_slice(values)) }
    }

    /// An attribute under a name made by [`xml_name`].
    pub(super) fn of_attribute(name: &'a str, attribute: &'a Attribute) -> Self {
        Self::of(name, "Float32", attribute.components as u32, &attribute.values)
    }

    /// An array of generated numbers.
    pub(super) fn generated(name: &'a str, kind: &'static str, data: Data<'a>) -> Self {
        Self { name, kind, components: 1, data }
    }

    pub(super) fn bytes(&self) -> u64 {
        match self.data {
            Data::Bytes(data) => data.len() as u64,
            Data::Number(_) => 8,
            Data::Range { count, .. } => 4 * count as u64,
            Data::Ends { count, .. } => 8 * count as u64,
            Data::Repeat { count, .. } => count as u64,
        }
    }

    /// Writes the declaration with an offset, which is advanced. `more` are further XML attributes.
    pub(super) fn declare(&self, out: &mut dyn Write, offset: &mut u64, more: &str) -> io::Result<()> {
        let Self { name, kind, .. } = self;
        write!(out, "<DataArray type=\"{kind}\" Name=\"{name}\"{more}")?;
        // A single component is omitted, as VTK does: `meshio` reads an explicit 1 as a matrix of one column.
        if self.components > 1 {
            write!(out, " NumberOfComponents=\"{}\"", self.components)?;
        }
        writeln!(out, " format=\"appended\" offset=\"{offset}\"/>")?;
        *offset += size_of::<u64>() as u64 + self.bytes();
        Ok(())
    }

    /// Writes the length and the bytes.
    pub(super) fn append(&self, out: &mut dyn Write) -> io::Result<()> {
        out.write_all(&self.bytes().to_le_bytes())?;
        match self.data {
            Data::Bytes(data) => out.write_all(data),
            Data::Number(value) => out.write_all(&value.to_le_bytes()),
            Data::Range { first, count } => generate(out, count, |i| first + i as i32),
            Data::Ends { corners, count } => generate(out, count, |i| corners * (i as i64 + 1)),
            Data::Repeat { value, count } => generate(out, count, |_| value),
        }
    }
}

/// Writes `count` numbers in chunks.
fn generate<T: NoUninit + Default>(
    out: &mut dyn Write,
    count: usize,
    number: impl Fn(usize) -> T,
) -> io::Result<()> {
    let mut chunk = [T::default(); CHUNK];
    for start in (0..count).step_by(CHUNK) {
        let length = CHUNK.min(count - start);
        for (i, value) in chunk[..length].iter_mut().enumerate() {
            *value = number(start + i);
        }
        out.write_all(bytemuck::cast_slice(&chunk[..length]))?;
    }
    Ok(())
}

/// The name of an attribute without characters that have a meaning in XML.
pub(super) fn xml_name(attribute: &Attribute) -> String {
    attribute.word().replace(['<', '>', '&', '"'], "_")
}
