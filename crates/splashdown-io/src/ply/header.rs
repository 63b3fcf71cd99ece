//! The header: text lines that name the encoding, the elements and their properties.

use super::source::Source;
use crate::data::ParticleInfo;
use crate::number::Number;

/// How the numbers after the header are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Encoding {
    /// One line per row.
    Text,
    Binary {
        big_endian: bool,
    },
}

#[derive(Debug)]
pub(super) struct Header {
    pub(super) encoding: Encoding,
    /// In the order of the file.
    pub(super) elements: Vec<Element>,
    /// From comments with a name and a number.
    pub(super) info: ParticleInfo,
}

/// A table of `count` rows.
#[derive(Debug)]
pub(super) struct Element {
    pub(super) name: String,
    pub(super) count: usize,
    /// In the order of the numbers in a row.
    pub(super) properties: Vec<Property>,
}

#[derive(Debug)]
pub(super) struct Property {
    pub(super) name: String,
    pub(super) kind: Kind,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Scalar(Number),
    /// A count, then as many items.
    List {
        count: Number,
        item: Number,
    },
}

impl Header {
    /// Reads the header up to and including the line `end_header`.
    pub(super) fn read(source: &mut Source) -> Result<Self, String> {
        if source.line()?.is_none_or(|line| line.trim_ascii_end() != b"ply") {
            return Err("it does not begin with the line `ply`".to_owned());
        }
        let (mut encoding, mut elements, mut info) = (None, Vec::<Element>::new(), ParticleInfo::default());
        loop {
            let line_number = source.line_number() + 1;
            let line = source.line()?.ok_or("its header has no line `end_header`: it was cut short")?;
            let line = String::from_utf8_lossy(line);
            let words: Vec<&str> = line.split_ascii_whitespace().collect();
            let parsed = match words[..] {
                ["comment" | "obj_info", name, value] => {
                    value.parse().into_iter().for_each(|value| info.set(name, value));
                    Ok(())
                }
                [] | ["comment" | "obj_info", ..] => Ok(()),
                ["format", name, version] => {
                    self::encoding(name, version).map(|found| encoding = Some(found))
                }
                ["element", name, count] => element(name, count, &elements).map(|found| elements.push(found)),
                ["property", ref kind @ .., name] => property(kind, name, elements.last_mut()),
                ["end_header"] => break,
                _ => {
                    Err("it is not one of `format`, `element`, `property`, `comment` and `end_header`"
                        .to_owned())
                }
            };
            let text = line.trim();
            parsed.map_err(|reason| format!("line {line_number} (`{text:.60}`): {reason}"))?;
        }
        let encoding = encoding.ok_or("its header has no line `format`")?;
        Ok(Self { encoding, elements, info })
    }

    pub(super) fn element(&self, name: &str) -> Option<&Element> {
        self.elements.iter().find(|element| element.name == name)
    }
}

fn encoding(name: &str, version: &str) -> Result<Encoding, String> {
    match (name, version) {
        ("ascii", "1.0") => Ok(Encoding::Text),
        ("binary_little_endian", "1.0") => Ok(Encoding::Binary { big_endian: false }),
        ("binary_big_endian", "1.0") => Ok(Encoding::Binary { big_endian: true }),
        _ => {
            Err("the formats `ascii`, `binary_little_endian` and `binary_big_endian` of version 1.0 are read"
                .to_owned())
        }
    }
}

fn element(name: &str, count: &str, others: &[Element]) -> Result<Element, String> {
    if others.iter().any(|other| other.name == name) {
        return Err(format!("the element `{name:.24}` is declared twice"));
    }
    let count = count.parse().map_err(|_| format!("`{count:.24}` is not a count"))?;
    Ok(Element { name: name.to_owned(), count, properties: Vec::new() })
}

fn property(kind: &[&str], name: &str, element: Option<&mut Element>) -> Result<(), String> {
    let element = element.ok_or("a property must follow its `element`")?;
    let kind = match *kind {
        [kind] => Kind::Scalar(number(kind)?),
        ["list", count, item] => Kind::List { count: number(count)?, item: number(item)? },
        _ => return Err("allowed are `property TYPE NAME` and `property list TYPE TYPE NAME`".to_owned()),
    };
    if matches!(kind, Kind::List { count: Number::F32 | Number::F64, .. }) {
        return Err("the count of a list must be an integer".to_owned());
    }
    if element.properties.iter().any(|other| other.name == name) {
        return Err(format!("the property `{name:.24}` is declared twice"));
    }
    element.properties.push(Property { name: name.to_owned(), kind });
    Ok(())
}

fn number(kind: &str) -> Result<Number, String> {
    Ok(match kind {
        "char" | "int8" => Number::I8,
        "uchar" | "uint8" => Number::U8,
        "short" | "int16" => Number::I16,
        "ushort" | "uint16" => Number::U16,
        "int" | "int32" => Number::I32,
        "uint" | "uint32" => Number::U32,
        "float" | "float32" => Number::F32,
        "double" | "float64" => Number::F64,
        _ => {
            return Err(format!(
                "the type `{kind:.24}` is not known; allowed are char, uchar, short, ushort, int, uint, float and double"
            ));
        }
    })
}

impl Element {
    /// Bytes of a binary row; `None` if it has a list.
    pub(super) fn row_size(&self) -> Option<usize> {
        self.properties
            .iter()
            .map(|property| match property.kind {
                Kind::Scalar(number) => Some(number.size()),
                Kind::List { .. } => None,
            })
            .sum()
    }

    /// Refuses an element that cannot fit into the file even if all its lists are empty, before memory is allocated
    /// for it.
    pub(super) fn check_size(&self, encoding: Encoding, file_size: u64) -> Result<(), String> {
        let smallest = |property: &Property| match (encoding, property.kind) {
            // A digit and a space.
            (Encoding::Text, _) => 2,
            (_, Kind::Scalar(number) | Kind::List { count: number, .. }) => number.size() as u64,
        };
        let row: u64 = self.properties.iter().map(smallest).sum();
        let Self { name, count, .. } = self;
        if *count > 0 && row == 0 {
            return Err(format!("its header declares {count} `{name:.24}` without any property"));
        }
        let needed = (*count as u64).saturating_mul(row);
        // The last line of a text file may lack its line break.
        if needed > file_size + 1 {
            return Err(format!(
                "its header declares {count} `{name:.24}`, which need at least {needed} bytes, but the file has \
                 {file_size}: it was cut short"
            ));
        }
        Ok(())
    }
}
