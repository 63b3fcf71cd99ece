//! The types in which `keys/` declares the scene file: kinds of values, keys, tables of keys.

use super::choice::Choice;

/// A word and its description.
pub(crate) type Word = (&'static str, &'static str);

/// The kind of a key's value.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Kind {
    /// A finite number.
    Number(Range),
    /// A list of this length of finite numbers, each in the range.
    Numbers(usize, Range),
    /// A number, or the name of a unit of length ([`UNITS`]).
    Scale(Range),
    /// As [`Kind::Scale`], or three of them: one for each axis of the file.
    Scales(Range),
    /// An integer.
    Integer(Range),
    /// A list of this length of integers, each in the range.
    Integers(usize, Range),
    /// `true` or `false`.
    Boolean,
    /// A short name that can be used as a folder name.
    Name,
    /// A text; the string describes the allowed texts.
    Text(&'static str),
    /// A text that may be empty, without line breaks; the string describes it.
    Line(&'static str),
    /// A list of this length of texts.
    Texts(usize, &'static str),
    /// One of some words.
    Word(fn() -> Vec<Word>),
    /// A list of words, each at most once.
    Words(fn() -> Vec<Word>),
    /// A table of keys.
    Table(&'static Table),
    /// A list of tables with at most this many items.
    Tables(&'static Table, usize),
}

/// Maximum number of characters of a [`Kind::Line`].
pub(crate) const LONGEST_LINE: usize = 80;

/// Units of length that a scale can name, in m.
pub(crate) const UNITS: &[(&str, f64)] =
    &[("mm", 0.001), ("cm", 0.01), ("m", 1.0), ("in", 0.0254), ("ft", 0.3048)];

/// A range that includes both ends.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Range {
    pub least: f64,
    pub most: f64,
    /// Unit for messages; empty for a pure number.
    pub unit: &'static str,
}

impl Range {
    pub fn contains(&self, value: f64) -> bool {
        (self.least..=self.most).contains(&value)
    }
}

impl std::fmt::Display for Range {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} to {}", number(self.least), number(self.most))?;
        if self.unit.is_empty() { Ok(()) } else { write!(f, " {}", self.unit) }
    }
}

/// A key of a table.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Key {
    pub name: &'static str,
    pub kind: Kind,
    pub required: bool,
    /// The default in the syntax of the file; empty if it is derived from other values.
    pub default: &'static str,
    /// One sentence for the schema and the reference.
    pub about: &'static str,
    /// Names that users may try instead, for suggestions.
    pub also: &'static [&'static str],
    /// Former names, which are still accepted with a warning.
    pub formerly: &'static [&'static str],
}

impl Key {
    pub const fn required(mut self) -> Self {
        self.required = true;
        self
    }

    pub const fn default(mut self, text: &'static str) -> Self {
        self.default = text;
        self
    }

    pub const fn also(mut self, names: &'static [&'static str]) -> Self {
        self.also = names;
        self
    }

    pub const fn formerly(mut self, names: &'static [&'static str]) -> Self {
        self.formerly = names;
        self
    }
}

/// A section of the file.
#[derive(Debug)]
pub(crate) struct Table {
    pub about: &'static str,
    pub keys: &'static [Key],
}

impl Table {
    pub fn key(&self, name: &str) -> Option<&'static Key> {
        self.keys.iter().find(|key| key.name == name)
    }

    /// The key that formerly had this name.
    pub fn key_formerly(&self, name: &str) -> Option<&'static Key> {
        self.keys.iter().find(|key| key.formerly.contains(&name))
    }
}

pub(crate) const fn key(name: &'static str, kind: Kind, about: &'static str) -> Key {
    Key { name, kind, required: false, default: "", about, also: &[], formerly: &[] }
}

pub(crate) const fn range(least: f64, most: f64, unit: &'static str) -> Range {
    Range { least, most, unit }
}

pub(crate) const fn a_number(least: f64, most: f64, unit: &'static str) -> Kind {
    Kind::Number(range(least, most, unit))
}

pub(crate) const fn a_vector(most: f64, unit: &'static str) -> Kind {
    Kind::Numbers(3, range(-most, most, unit))
}

/// The words of a [`Choice`].
pub(crate) fn words<C: Choice>() -> Vec<Word> {
    C::ALL.iter().map(|&(_, word, about)| (word, about.trim())).collect()
}

/// A number computed in f32, rounded to its significant digits.
pub(crate) fn rounded(value: f32) -> String {
    number(format!("{value:.3e}").parse().unwrap_or(f64::from(value)))
}

/// A number in decimal notation, or in scientific notation if it is very large or small.
pub(crate) fn number(value: f64) -> String {
    let size = value.abs();
    if size != 0.0 && !(1e-3..1e6).contains(&size) { format!("{value:e}") } else { format!("{value}") }
}

/// A point in m, its coordinates rounded to their significant digits.
pub(crate) fn place(x: [f32; 3]) -> String {
    format!("[{}]", x.map(rounded).join(", "))
}
