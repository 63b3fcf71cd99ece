//! Formats numbers as text, through a buffer.

use std::io::{self, Write};

/// Bytes per write.
const CHUNK: usize = 1 << 16;

/// A list of values separated by commas.
pub(super) struct Text<'a> {
    out: &'a mut dyn Write,
    buffer: Vec<u8>,
    first: bool,
}

impl<'a> Text<'a> {
    pub(super) fn new(out: &'a mut dyn Write) -> Self {
        Self { out, buffer: Vec::with_capacity(CHUNK + 256), first: true }
    }

    pub(super) fn vector(&mut self, [x, y, z]: [f32; 3]) -> io::Result<()> {
        self.separate()?;
        self.buffer.push(b'(');
        self.float(x);
        self.buffer.extend(b", ");
        self.float(y);
        self.buffer.extend(b", ");
        self.float(z);
        self.buffer.push(b')');
        Ok(())
    }

    pub(super) fn number(&mut self, value: f32) -> io::Result<()> {
        self.separate()?;
        self.float(value);
        Ok(())
    }

    pub(super) fn integer(&mut self, value: u32) -> io::Result<()> {
        self.separate()?;
        self.buffer.extend_from_slice(itoa::Buffer::new().format(value).as_bytes());
        Ok(())
    }

    pub(super) fn finish(self) -> io::Result<()> {
        self.out.write_all(&self.buffer)
    }

    /// Writes the fewest digits from which the same float is read. In USD, `nan` and `inf` are lower case.
    fn float(&mut self, value: f32) {
        let mut digits = zmij::Buffer::new();
        let word = match value {
            _ if value.is_nan() => "nan",
            f32::INFINITY => "inf",
            f32::NEG_INFINITY => "-inf",
            _ => digits.format_finite(value),
        };
        self.buffer.extend_from_slice(word.as_bytes());
    }

    fn separate(&mut self) -> io::Result<()> {
        if !std::mem::take(&mut self.first) {
            self.buffer.extend(b", ");
        }
        if self.buffer.len() >= CHUNK {
            self.out.write_all(&self.buffer)?;
            self.buffer.clear();
        }
        Ok(())
    }
}

/// The lower and upper corner of the bounding box of all finite points; the origin if there are none.
pub(super) fn extent(points: &[[f32; 3]]) -> [[f32; 3]; 2] {
    let mut finite = points.iter().filter(|point| point.iter().all(|component| component.is_finite()));
    let Some(&first) = finite.next() else { return [[0.0; 3]; 2] };
    finite.fold([first, first], |[low, high], point| {
        [
            std::array::from_fn(|axis| low[axis].min(point[axis])),
            std::array::from_fn(|axis| high[axis].max(point[axis])),
        ]
    })
}
