//! The reader of text and binary files, as written by SPlisHSPlasH, `meshio` and ParaView.

use std::path::Path;

use crate::data::columns::{Wanted, triples};
use crate::data::{ParticleInfo, Particles};
use crate::error::IoError;
use crate::input::{content, not_particles};
use crate::number::Number;

pub(crate) fn read(path: &Path, wanted: Wanted) -> Result<Particles, IoError> {
    let bytes = content(path)?;
    let mut file = Cursor { bytes: &bytes, at: 0, binary: false, wanted };
    file.parse().map_err(|reason| {
        let place = file.at.min(bytes.len());
        IoError::malformed(path, "VTK", format!("{reason} (near byte {place} of {})", bytes.len()))
    })
}

/// A position in the file.
struct Cursor<'a> {
    bytes: &'a [u8],
    at: usize,
    binary: bool,
    wanted: Wanted,
}

/// The kind of elements that the following arrays belong to, with their number.
#[derive(Clone, Copy, PartialEq)]
enum Owner {
    Points(usize),
    /// The points and cells together, as single numbers.
    Whole,
    Others(usize),
}

impl Cursor<'_> {
    fn parse(&mut self) -> Result<Particles, String> {
        if !self.line().is_some_and(|line| line.starts_with("# vtk DataFile Version")) {
            return Err("it does not begin with `# vtk DataFile Version`".to_owned());
        }
        // The second line is a title and may be empty.
        self.line();
        self.binary = match self.words()?.first().map(String::as_str) {
            Some("BINARY") => true,
            Some("ASCII") => false,
            _ => return Err("its third line is neither `ASCII` nor `BINARY`".to_owned()),
        };
        let mut particles = Particles::default();
        let mut owner = Owner::Whole;
        while let Ok(words) = self.words() {
            let word = |n: usize| words.get(n).map_or("", String::as_str);
            match word(0) {
                "DATASET" if !matches!(word(1), "POLYDATA" | "UNSTRUCTURED_GRID") => {
                    let kind = word(1);
                    return Err(format!("it is a `{kind}`; POLYDATA and UNSTRUCTURED_GRID are read"));
                }
                "DATASET" => {}
                "POINTS" => {
                    let values = self.numbers(count(word(1))?, 3, word(2))?;
                    particles.positions = triples(&values).collect();
                }
                "VERTICES" | "LINES" | "POLYGONS" | "TRIANGLE_STRIPS" | "CELLS" => self.cells(&words)?,
                "CELL_TYPES" => self.skip(count(word(1))?, 1, "int")?,
                "POINT_DATA" => owner = Owner::Points(count(word(1))?),
                "CELL_DATA" => owner = Owner::Others(count(word(1))?),
                // It ends with an empty line.
                "METADATA" => while self.line().is_some_and(|line| !line.trim().is_empty()) {},
                "LOOKUP_TABLE" => {
                    self.skip(count(word(2))?, 4, if self.binary { "unsigned_char" } else { "float" })?
                }
                "FIELD" => self.field(count(word(2))?, owner, &mut particles)?,
                keyword => self.attribute(keyword, &words, owner, &mut particles)?,
            }
        }
        Ok(particles)
    }

    /// Reads an array that has a keyword of its own.
    fn attribute(
        &mut self,
        keyword: &str,
        words: &[String],
        owner: Owner,
        particles: &mut Particles,
    ) -> Result<(), String> {
        let (name, kind) = (words.get(1).map_or("", String::as_str), words.get(2).map_or("", String::as_str));
        let components = match keyword {
            "SCALARS" => words.get(3).map_or(Ok(1), |given| count(given))?,
            "VECTORS" | "NORMALS" => 3,
            "TENSORS" => 9,
            _ => {
                return Err(format!("`{keyword:.24}` is not a known keyword"));
            }
        };
        if keyword == "SCALARS" {
            let before = self.at;
            // The line with the name of a colour table is optional, but almost every file has it.
            if self.words()?.first().is_none_or(|word| word != "LOOKUP_TABLE") {
                self.at = before;
            }
        }
        self.array(name, components, kind, owner, particles)
    }

    /// Reads the arrays of a `FIELD`, each with a line `name components tuples type`.
    fn field(&mut self, arrays: usize, owner: Owner, particles: &mut Particles) -> Result<(), String> {
        for _ in 0..arrays {
            let mut words = self.words()?;
            if words.first().is_some_and(|word| word == "METADATA") {
                while self.line().is_some_and(|line| !line.trim().is_empty()) {}
                words = self.words()?;
            }
            let [name, components, tuples, kind] = words.as_slice() else {
                return Err("an array of a FIELD needs `name components tuples type`".to_owned());
            };
            let (components, tuples) = (count(components)?, count(tuples)?);
            // A field can precede `POINT_DATA` and have a length of its own.
            let owner = match owner {
                Owner::Points(points) if points == tuples => owner,
                Owner::Whole if tuples == 1 => owner,
                _ => Owner::Others(tuples),
            };
            self.array(name, components, kind, owner, particles)?;
        }
        Ok(())
    }

    fn array(
        &mut self,
        name: &str,
        components: usize,
        kind: &str,
        owner: Owner,
        particles: &mut Particles,
    ) -> Result<(), String> {
        match owner {
            Owner::Points(points) if self.wanted.has(name, components) => {
                let values = self.numbers(points, components, kind)?;
                self.wanted.append(particles, name, components, &values)
            }
            Owner::Whole if components == 1 && ParticleInfo::has(name) => {
                self.numbers(1, 1, kind)?.into_iter().for_each(|value| particles.info.set(name, value));
                Ok(())
            }
            Owner::Whole => self.skip(1, components, kind),
            Owner::Points(rows) | Owner::Others(rows) => self.skip(rows, components, kind),
        }
    }

    /// Skips a list of cells, in the old form (one list of integers) or the new form (two typed arrays).
    fn cells(&mut self, words: &[String]) -> Result<(), String> {
        let number = |n: usize| count(words.get(n).map_or("", String::as_str));
        let (first, second) = (number(1)?, number(2)?);
        let before = self.at;
        let offsets = self.words().unwrap_or_default();
        let is_new = offsets.first().is_some_and(|word| word == "OFFSETS");
        // A mesh has triangles or quadrilaterals. Particle files have a cell per point, or one cell of all points.
        let (cells, corners) =
            if is_new { (first.saturating_sub(1), second) } else { (first, second.saturating_sub(first)) };
        let is_mesh = cells > 1 && [3, 4].iter().any(|n| cells.checked_mul(*n) == Some(corners));
        if is_mesh || (cells > 0 && words.first().is_some_and(|word| word == "POLYGONS")) {
            return Err(not_particles(cells));
        }
        if is_new {
            self.skip(first, 1, offsets.get(1).map_or("", String::as_str))?;
            let connectivity = self.words()?;
            return self.skip(second, 1, connectivity.get(1).map_or("", String::as_str));
        }
        self.at = before;
        self.skip(second, 1, "int")
    }

    /// Reads `rows` x `components` numbers.
    fn numbers(&mut self, rows: usize, components: usize, kind: &str) -> Result<Vec<f64>, String> {
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

    fn skip(&mut self, rows: usize, components: usize, kind: &str) -> Result<(), String> {
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
    fn line(&mut self) -> Option<String> {
        let left = self.bytes.get(self.at..).filter(|left| !left.is_empty())?;
        let length = left.iter().position(|&byte| byte == b'\n');
        self.at += length.map_or(left.len(), |length| length + 1);
        Some(String::from_utf8_lossy(&left[..length.unwrap_or(left.len())]).into_owned())
    }

    /// Reads the words of the next line that is not empty.
    fn words(&mut self) -> Result<Vec<String>, String> {
        while let Some(line) = self.line() {
            let words: Vec<String> = line.split_ascii_whitespace().map(str::to_owned).collect();
            if !words.is_empty() {
                return Ok(words);
            }
        }
        Err("it was cut short".to_owned())
    }
}

fn count(word: &str) -> Result<usize, String> {
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
