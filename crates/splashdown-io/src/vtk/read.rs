//! The reader of text and binary files, as written by SPlisHSPlasH, `meshio` and ParaView.

use std::path::Path;

use super::cursor::{Cursor, FieldArray, count};
use crate::data::columns::{Wanted, triples};
use crate::data::{ParticleInfo, Particles};
use crate::error::IoError;
use crate::input::{content, not_particles};

pub(crate) fn read(path: &Path, wanted: Wanted) -> Result<Particles, IoError> {
    let bytes = content(path)?;
    let malformed = |reason| IoError::malformed(path, "VTK", reason);
    let mut reader = Reader { file: Cursor::start(&bytes).map_err(malformed)?, wanted };
    reader.parse().map_err(|reason| malformed(reader.file.located(&reason)))
}

struct Reader<'a> {
    file: Cursor<'a>,
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

impl Reader<'_> {
    fn parse(&mut self) -> Result<Particles, String> {
        let mut particles = Particles::default();
        let mut owner = Owner::Whole;
        while let Ok(words) = self.file.words() {
            let word = |n: usize| words.get(n).map_or("", String::as_str);
            match word(0) {
                "DATASET" => Cursor::check_kind(word(1))?,
                "POINTS" => {
                    let values = self.file.numbers(count(word(1))?, 3, word(2))?;
                    particles.positions = triples(&values).collect();
                }
                "VERTICES" | "LINES" | "POLYGONS" | "TRIANGLE_STRIPS" | "CELLS" => self.cells(&words)?,
                "CELL_TYPES" => self.file.skip(count(word(1))?, 1, "int")?,
                "POINT_DATA" => owner = Owner::Points(count(word(1))?),
                "CELL_DATA" => owner = Owner::Others(count(word(1))?),
                "METADATA" => self.file.metadata(),
                "LOOKUP_TABLE" => self.file.skip(
                    count(word(2))?,
                    4,
                    if self.file.is_binary() { "unsigned_char" } else { "float" },
                )?,
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
            let before = self.file.position();
            // The line with the name of a colour table is optional, but almost every file has it.
            if self.file.words()?.first().is_none_or(|word| word != "LOOKUP_TABLE") {
                self.file.return_to(before);
            }
        }
        self.array(name, components, kind, owner, particles)
    }

    /// Reads the arrays of a `FIELD`, each with a line `name components tuples type`.
    fn field(&mut self, arrays: usize, owner: Owner, particles: &mut Particles) -> Result<(), String> {
        for _ in 0..arrays {
            let FieldArray { name, components, tuples, kind } = self.file.field_array()?;
            // A field can precede `POINT_DATA` and have a length of its own.
            let owner = match owner {
                Owner::Points(points) if points == tuples => owner,
                Owner::Whole if tuples == 1 => owner,
                _ => Owner::Others(tuples),
            };
            self.array(&name, components, &kind, owner, particles)?;
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
                let values = self.file.numbers(points, components, kind)?;
                self.wanted.append(particles, name, components, &values)
            }
            Owner::Whole if components == 1 && ParticleInfo::has(name) => {
                self.file.numbers(1, 1, kind)?.into_iter().for_each(|value| particles.info.set(name, value));
                Ok(())
            }
            Owner::Whole => self.file.skip(1, components, kind),
            Owner::Points(rows) | Owner::Others(rows) => self.file.skip(rows, components, kind),
        }
    }

    /// Skips a list of cells, in the old form (one list of integers) or the new form (two typed arrays).
    fn cells(&mut self, words: &[String]) -> Result<(), String> {
        let number = |n: usize| count(words.get(n).map_or("", String::as_str));
        let (first, second) = (number(1)?, number(2)?);
        let before = self.file.position();
        let offsets = self.file.words().unwrap_or_default();
        let is_new = offsets.first().is_some_and(|word| word == "OFFSETS");
        // A mesh has triangles or quadrilaterals. Particle files have a cell per point, or one cell of all points.
        let (cells, corners) =
            if is_new { (first.saturating_sub(1), second) } else { (first, second.saturating_sub(first)) };
        let is_mesh = cells > 1 && [3, 4].iter().any(|n| cells.checked_mul(*n) == Some(corners));
        if is_mesh || (cells > 0 && words.first().is_some_and(|word| word == "POLYGONS")) {
            return Err(not_particles(cells));
        }
        if is_new {
            self.file.skip(first, 1, offsets.get(1).map_or("", String::as_str))?;
            let connectivity = self.file.words()?;
            return self.file.skip(second, 1, connectivity.get(1).map_or("", String::as_str));
        }
        self.file.return_to(before);
        self.file.skip(second, 1, "int")
    }
}
