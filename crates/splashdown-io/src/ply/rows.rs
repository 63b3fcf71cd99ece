//! The rows of an element, as one array per property.

use super::header::{Element, Encoding, Kind, Property};
use super::source::Source;
use crate::input::push_fan;
use crate::number::{Cells, Number, whole};

/// Rows without lists that are decoded at a time.
const ROWS: usize = 1024;

/// The values that are read of one property.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Column {
    /// Nothing.
    Skipped,
    Floats(Vec<f32>),
    /// Ids; f32 would be exact only up to 2^24.
    Integers(Vec<u32>),
    /// Lists of vertex numbers, split into triangles that share the first vertex.
    Fans(Vec<[u32; 3]>),
}

/// Reads all rows of an element; `columns` has an entry for each property. A message names the row or line.
pub(super) fn read(
    source: &mut Source,
    element: &Element,
    encoding: Encoding,
    columns: &mut [Column],
) -> Result<(), String> {
    for column in &mut *columns {
        match column {
            Column::Skipped => {}
            // `Element::check_size` has bounded the count by the size of the file.
            Column::Floats(values) => values.reserve(element.count),
            Column::Integers(values) => values.reserve(element.count),
            Column::Fans(triangles) => triangles.reserve(element.count),
        }
    }
    match (encoding, element.row_size()) {
        (Encoding::Text, _) => text(source, element, columns),
        (Encoding::Binary { big_endian }, Some(size)) => table(source, element, size, big_endian, columns),
        (Encoding::Binary { big_endian }, None) => lists(source, element, big_endian, columns),
    }
}

/// Binary rows of equal size, column by column.
fn table(
    source: &mut Source,
    element: &Element,
    stride: usize,
    big_endian: bool,
    columns: &mut [Column],
) -> Result<(), String> {
    let (count, complete) = (element.count, source.left() / stride.max(1) as u64);
    if complete < count as u64 {
        return Err(format!(
            "{count} rows are declared, but the file ends after {complete}: it was cut short"
        ));
    }
    if columns.iter().all(|column| *column == Column::Skipped) {
        return source.skip(count as u64 * stride as u64);
    }
    for first in (0..count).step_by(ROWS) {
        let bytes = source.take(stride * ROWS.min(count - first))?;
        let mut at = 0;
        for (property, column) in element.properties.iter().zip(&mut *columns) {
            let Kind::Scalar(number) = property.kind else { continue };
            let cells = Cells { at, components: 1, stride, big_endian };
            match column {
                Column::Floats(values) => number.decode_cells(bytes, cells, values),
                Column::Integers(values) => {
                    let mut given = Vec::new();
                    number.decode_cells(bytes, cells, &mut given);
                    for (row, value) in given.into_iter().enumerate() {
                        let integer = integer(value, property);
                        values.push(integer.map_err(|reason| format!("row {}: {reason}", first + row))?);
                    }
                }
                Column::Skipped | Column::Fans(_) => {}
            }
            at += number.size();
        }
    }
    Ok(())
}

/// Binary rows with lists, one after the other.
fn lists(
    source: &mut Source,
    element: &Element,
    big_endian: bool,
    columns: &mut [Column],
) -> Result<(), String> {
    let (mut numbers, mut corners) = (Vec::<f64>::new(), Vec::new());
    let decode = |bytes: &[u8], number: Number, numbers: &mut Vec<f64>| {
        numbers.clear();
        let cells = Cells { at: 0, components: 1, stride: number.size(), big_endian };
        number.decode_cells(bytes, cells, numbers);
    };
    for row in 0..element.count {
        for (property, column) in element.properties.iter().zip(&mut *columns) {
            let (Kind::Scalar(first) | Kind::List { count: first, .. }) = property.kind;
            let mut fill = || -> Result<(), String> {
                decode(source.take(first.size())?, first, &mut numbers);
                let Kind::List { item, .. } = property.kind else { return column.push(numbers[0], property) };
                let size = u64::from(integer(numbers[0], property)?) * item.size() as u64;
                let Column::Fans(triangles) = column else { return source.skip(size) };
                decode(source.take(size as usize)?, item, &mut numbers);
                corners.clear();
                for &number in &numbers {
                    corners.push(integer(number, property)?);
                }
                push_polygon(triangles, &corners, row)
            };
            fill().map_err(|reason| format!("row {row}: {reason}"))?;
        }
    }
    Ok(())
}

/// One line per row. Empty lines are ignored, and so are words after the last property.
fn text(source: &mut Source, element: &Element, columns: &mut [Column]) -> Result<(), String> {
    let mut corners = Vec::new();
    let is_skipped = columns.iter().all(|column| *column == Column::Skipped);
    let (count, mut row) = (element.count, 0);
    while row < count {
        let number = source.line_number() + 1;
        let line = source.line()?.ok_or_else(|| {
            format!("{count} rows are declared, but the file ends after {row}: it was cut short")
        })?;
        if line.trim_ascii().is_empty() {
            continue;
        }
        if !is_skipped {
            let line = String::from_utf8_lossy(line);
            let mut words = line.split_ascii_whitespace();
            for (property, column) in element.properties.iter().zip(&mut *columns) {
                parse(&mut words, property, column, &mut corners, row)
                    .map_err(|reason| format!("line {number}: {reason}"))?;
            }
        }
        row += 1;
    }
    Ok(())
}

/// Parses the words of one property.
fn parse<'a>(
    words: &mut impl Iterator<Item = &'a str>,
    property: &Property,
    column: &mut Column,
    corners: &mut Vec<u32>,
    row: usize,
) -> Result<(), String> {
    let name = &property.name;
    let mut next = |number: Number| -> Result<f64, String> {
        let word = words.next().ok_or_else(|| format!("it ends before property `{name:.24}`"))?;
        let value = number.parse(word);
        value.ok_or_else(|| format!("`{word:.24}` is not a number of the type of property `{name:.24}`"))
    };
    match property.kind {
        Kind::Scalar(number) => column.push(next(number)?, property),
        Kind::List { count, item } => {
            corners.clear();
            let is_read = matches!(column, Column::Fans(_));
            for _ in 0..integer(next(count)?, property)? {
                let item = next(item)?;
                if is_read {
                    corners.push(integer(item, property)?);
                }
            }
            match column {
                Column::Fans(triangles) => push_polygon(triangles, corners, row),
                _ => Ok(()),
            }
        }
    }
}

impl Column {
    /// Appends one number.
    fn push(&mut self, value: f64, property: &Property) -> Result<(), String> {
        match self {
            // Converting an f32 to f64 and back does not change it.
            Self::Floats(values) => values.push(value as f32),
            Self::Integers(values) => values.push(integer(value, property)?),
            Self::Skipped | Self::Fans(_) => {}
        }
        Ok(())
    }
}

fn integer(value: f64, property: &Property) -> Result<u32, String> {
    whole(value).ok_or_else(|| {
        format!("property `{:.24}`: {value} is not an integer from 0 to {}", property.name, u32::MAX)
    })
}

fn push_polygon(triangles: &mut Vec<[u32; 3]>, corners: &[u32], row: usize) -> Result<(), String> {
    match corners.len() {
        0 => Err(format!("face {row} has no corners, at least 3 are needed")),
        1 | 2 => Err(format!("face {row} has {} corners, at least 3 are needed", corners.len())),
        _ => push_fan(triangles, corners),
    }
}
