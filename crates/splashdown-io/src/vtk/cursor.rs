//! A position in a file, from which lines and arrays are read.

use crate::number::{Number, wholes};

pub(super) struct Cursor<'a> {
    bytes: &'a [u8],
    at: usize,
    binary: bool,
}

/// The declaration of an array of a `FIELD`.
pub(super) struct FieldArray {
    pub(super) name: String,
    pub(super) components: usize,
    pub(super) tuples: usize,
    pub(super) kind: String,
}

/// The corners of polygons or other cells.
pub(super) struct Cells {
    /// The point numbers of all cells.
    pub(super) corners: Vec<u32>,
    /// The position after the last corner of each cell.
    pub(super) ends: Vec<u32>,
}

impl<'a> Cursor<'a> {
    /// The position after the first three lines, which name the format and its encoding.
    pub(super) fn start(bytes: &'a [u8]) -> Result<Self, String> {
        let mut file = Self { bytes, at: 0, binary: false };
        if !file.line().is_some_and(|line| line.starts_with("# vtk DataFile Version")) {
            return Err("it does not begin with `# vtk DataFile Version`".to_owned());
        }
        // The second line is a title and may be empty.
        file.line();
        file.binary = match file.words()?.first().map(String::as_str) {
            Some("BINARY") => true,
            Some("ASCII") => false,
            _ => return Err("its third line is neither `ASCII` nor `BINARY`".to_owned()),
        };
        Ok(file)
    }

    /// Refuses data sets of other kinds.
    pub(super) fn check_kind(kind: &str) -> Result<(), String> {
        match kind {
            "POLYDATA" | "UNSTRUCTURED_GRID" => Ok(()),
            _ => Err(format!("it is a `{kind}`; POLYDATA and UNSTRUCTURED_GRID are read")),
        }
    }

    /// Adds the position to a message.
    pub(super) fn located(&self, reason: &str) -> String {
        let place = self.at.min(self.bytes.len());
        format!("{reason} (near byte {place} of {})", self.bytes.len())
    }

    /// Whether the numbers are binary.
    pub(super) fn is_binary(&self) -> bool {
        self.binary
    }

    /// The position, for [`return_to`](Self::return_to).
    pub(super) fn position(&self) -> usize {
        self.at
    }

    pub(super) fn return_to(&mut self, position: usize) {
        self.at = position;
    }

    /// Skips a block `METADATA`, which ends with an empty line.
    pub(super) fn metadata(&mut self) {
        while self.line().is_some_and(|line| !line.trim().is_empty()) {}
    }

    /// Reads the line `name components tuples type` of an array of a `FIELD`.
    pub(super) fn field_array(&mut self) -> Result<FieldArray, String> {
        let mut words = self.words()?;
        if words.first().is_some_and(|word| word == "METADATA") {
            self.metadata();
            words = self.words()?;
        }
        let [name, components, tuples, kind] = <[String; 4]>::try_from(words)
            .map_err(|_| "an array of a FIELD needs `name components tuples type`")?;
        let (components, tuples) = (count(&components)?, count(&tuples)?);
        Ok(FieldArray { name, components, tuples, kind })
    }

    /// Reads a list of cells whose line has two counts, in the old form (one list of integers) or the new form (two typed
    /// arrays).
    pub(super) fn cells(&mut self, first: usize, second: usize) -> Result<Cells, String> {
        let before = self.at;
        let offsets = self.words().unwrap_or_default();
        if offsets.first().is_none_or(|word| word != "OFFSETS") {
            self.at = before;
            return Self::old_cells(first, &self.numbers(second, 1, "int")?);
        }
        let kind = |words: &[String]| words.get(1).cloned().unwrap_or_default();
        let mut ends = self.numbers(first, 1, &kind(&offsets))?;
        // The first offset is 0.
        ends.drain(..ends.len().min(1));
        let connectivity = self.words()?;
        let corners = self.numbers(second, 1, &kind(&connectivity))?;
        Ok(Cells { corners: wholes(&corners, "vertex number")?, ends: wholes(&ends, "count")? })
    }

    /// Splits a list of cells, each as its number of points and the points.
    fn old_cells(count: usize, list: &[f64]) -> Result<Cells, String> {
        let (mut corners, mut ends, mut rest) = (Vec::with_capacity(list.len()), Vec::new(), list);
        while let [length, others @ ..] = rest {
            let cell = others.get(..*length as usize).ok_or("its list of cells is cut short")?;
            corners.extend_from_slice(cell);
            // The counts of a file are below 2^32.
            ends.push(corners.len() as u32);
            rest = &others[cell.len()..];
        }
        if ends.len() != count {
            return Err(format!("its list has {} cells instead of {count}", ends.len()));
        }
        Ok(Cells { corners: wholes(&corners, "vertex number")?, ends })
    }

    /// Reads `rows` x `components` numbers.
    pub(super) fn numbers(&mut self, rows: usize, components: usize, kind: &str) -> Result<Vec<f64>, String> {
        let number = number(kind)?;
        let total = rows.checked_mul(components).ok_or("an array is too large")?;
        let left = &self.bytes[self.at..];
        // In text each number needs at least a digit and a space.
        let needed =
            total.checked_mul(if self.binary { number.size() } else { 2 }).ok_or("an array is too large")?;
        if needed > left.len() + 1 {
            return Err(format!(
                "an array of {total} numbers needs at least {needed} bytes, {} are left: it was cut short",
                left.len()
            ));
        }
        if self.binary {
            let bytes = left.get(..needed).ok_or("it was cut short inside an array")?;
            self.at += needed;
            return Ok(number.decode(bytes, true));
        }
        (0..total).map(|_| self.number()).collect()
    }

    pub(super) fn skip(&mut self, rows: usize, components: usize, kind: &str) -> Result<(), String> {
        let number = number(kind)?;
        if !self.binary {
            return self.numbers(rows, components, kind).map(drop);
        }
        let size = rows.checked_mul(components).and_then(|total| total.checked_mul(number.size()));
        let end = size.and_then(|size| size.checked_add(self.at)).filter(|&end| end <= self.bytes.len());
        self.at = end.ok_or("it was cut short inside an array")?;
        Ok(())
    }

    /// Reads the next number of a text file.
    fn number(&mut self) -> Result<f64, String> {
        let left = &self.bytes[self.at..];
        let start = left.iter().position(|byte| !byte.is_ascii_whitespace());
        let start = start.ok_or("it was cut short inside an array")?;
        let length = left[start..].iter().position(u8::is_ascii_whitespace).unwrap_or(left.len() - start);
        let word = String::from_utf8_lossy(&left[start..start + length]);
        let value = word.parse().map_err(|_| format!("`{word:.24}` is not a number"))?;
        self.at += start + length;
        Ok(value)
    }

    /// Reads the next line without its line feed; `None` at the end of the file.
    pub(super) fn line(&mut self) -> Option<String> {
        let left = self.bytes.get(self.at..).filter(|left| !left.is_empty())?;
        let length = left.iter().position(|&byte| byte == b'\n');
        self.at += length.map_or(left.len(), |length| length + 1);
        Some(String::from_utf8_lossy(&left[..length.unwrap_or(left.len())]).into_owned())
    }

    /// Reads the words of the next line that is not empty.
    pub(super) fn words(&mut self) -> Result<Vec<String>, String> {
        while let Some(line) = self.line() {
            let words: Vec<String> = line.split_ascii_whitespace().map(str::to_owned).collect();
            if !words.is_empty() {
                return Ok(words);
            }
        }
        Err("it was cut short".to_owned())
    }
}

pub(super) fn count(word: &str) -> Result<usize, String> {
    word.parse().map_err(|_| format!("`{word:.24}` is not a count"))
}

fn number(kind: &str) -> Result<Number, String> {
    Ok(match kind.to_ascii_lowercase().as_str() {
        "char" | "vtktypeint8" => Number::I8,
        "unsigned_char" | "vtktypeuint8" => Number::U8,
        "short" | "vtktypeint16" => Number::I16,
        "unsigned_short" | "vtktypeuint16" => Number::U16,
        // VTK writes its index type as `int`, independent of its size in memory.
        "int" | "vtktypeint32" | "vtkidtype" => Number::I32,
        "unsigned_int" | "vtktypeuint32" => Number::U32,
        // Its size on 64-bit Unix systems.
        "long" | "vtktypeint64" => Number::I64,
        "unsigned_long" | "vtktypeuint64" => Number::U64,
        "float" => Number::F32,
        "double" => Number::F64,
        _ => return Err(format!("`{kind:.24}` is not a known number type")),
    })
}
