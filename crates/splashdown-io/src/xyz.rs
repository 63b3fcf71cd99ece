//! XYZ, a plain list of points: a reader.
//!
//! Three formats have this ending: text with a point per line and optional further columns; the text format of
//! chemistry, with a count, a title and the name of an element before every point; and raw little-endian float32, three
//! per point, which `splashsurf` reads. A file with a byte that is not text is of the third format, unless it is text in
//! UTF-16. Empty lines and lines that begin with `#` or `//` are skipped. Words are separated by white space, commas or
//! semicolons; between semicolons a comma is the decimal separator. In the format of chemistry an element may be given
//! by its number.

use std::path::Path;

use crate::data::Particles;
use crate::data::columns::Wanted;
use crate::error::IoError;
use crate::input::content;

pub(crate) fn read(path: &Path, _: Wanted) -> Result<Particles, IoError> {
    let bytes = content(path)?;
    let is_text = |&byte: &u8| byte >= b' ' || matches!(byte, b'\t' | b'\n' | b'\r');
    let positions = if bytes.iter().all(is_text) && std::str::from_utf8(&bytes).is_ok() {
        text(&String::from_utf8_lossy(&bytes))
    } else if let Some(wide) = utf_16(&bytes) {
        text(&wide)
    } else if bytes.len().is_multiple_of(12) {
        Ok(bytes.chunks_exact(12).map(bytemuck::pod_read_unaligned).collect())
    } else {
        Err(format!(
            "it is not text, and its {} bytes are not a multiple of 12, the size of a point of three float32",
            bytes.len()
        ))
    };
    let positions = positions.map_err(|reason| IoError::malformed(path, "XYZ", reason))?;
    Ok(Particles::from_positions(positions))
}

/// The text of a file in UTF-16 with a byte order mark, as some programs on Windows write it. The mark may also be the
/// beginning of a number: only text without control characters counts.
fn utf_16(bytes: &[u8]) -> Option<String> {
    let unit = match bytes {
        [0xff, 0xfe, ..] => u16::from_le_bytes,
        [0xfe, 0xff, ..] => u16::from_be_bytes,
        _ => return None,
    };
    let (pairs, []) = bytes[2..].as_chunks() else { return None };
    let text = String::from_utf16(&pairs.iter().map(|pair| unit(*pair)).collect::<Vec<_>>()).ok()?;
    let is_text = |c: char| !c.is_control() || matches!(c, '\t' | '\n' | '\r');
    text.chars().all(is_text).then_some(text)
}

fn text(text: &str) -> Result<Vec<[f32; 3]>, String> {
    let mut lines = text.trim_start_matches('\u{feff}').lines().enumerate().peekable();
    let mut positions = Vec::new();
    let mut count = None;
    // A first line with a single integer is the count of the chemistry format; the next line is a title.
    if let Some(given) = lines.peek().and_then(|(_, line)| line.trim().parse::<usize>().ok()) {
        count = Some(given);
        lines.next();
        lines.next();
    }
    // Whether every line of the chemistry format begins with the number of an element.
    let mut has_elements = count.is_some();
    let mut elements = Vec::new();
    for (number, line) in lines {
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') || line.starts_with("//") {
            continue;
        }
        let fields = line.split(';').filter(|field| !field.trim().is_empty()).count();
        let line = if fields >= 3 { &line.replace(',', ".") } else { line };
        let mut words = words(line);
        if line.starts_with(|c: char| c.is_ascii_alphabetic()) && !is_number(line) {
            words.next();
            has_elements = false;
        }
        let is_element = words.clone().next().and_then(|word| word.parse::<u8>().ok());
        let is_element = is_element.is_some_and(|number| (1..=118).contains(&number));
        let mut next = || words.next().and_then(|word| word.parse::<f32>().ok());
        match [next(), next(), next()] {
            [Some(x), Some(y), Some(z)] => {
                positions.push([x, y, z]);
                let fourth = next().filter(|_| has_elements && is_element);
                has_elements = fourth.is_some();
                elements.extend(fourth.map(|last| [y, z, last]));
            }
            _ => {
                return Err(format!("line {} does not have three numbers: `{line:.40}`", number + 1));
            }
        }
    }
    match count {
        Some(count) if count != positions.len() => {
            Err(format!("its first line declares {count} points, but it has {}", positions.len()))
        }
        _ => Ok(if has_elements { elements } else { positions }),
    }
}

fn words(line: &str) -> impl Iterator<Item = &str> + Clone {
    line.split([' ', '\t', ',', ';']).filter(|word| !word.is_empty())
}

/// Whether the first word is a number, also `nan` or `inf`.
fn is_number(line: &str) -> bool {
    words(line).next().is_some_and(|word| word.parse::<f32>().is_ok())
}

#[cfg(test)]
mod tests {
    use super::{text, utf_16};

    #[test]
    fn lists_and_the_chemistry_format_are_read() {
        let points = [[1.0, -2.5, 3e-3], [4.0, 5.0, 6.0]];
        for given in [
            "1 -2.5 3e-3\n4 5 6\n",
            "# x y z\n\n1,-2.5,3e-3\r\n4;5;6",
            "2\nwater at 0 s\nH 1 -2.5 3e-3\nO2 4 5 6\n",
            "2\nwater with numbers of elements\n1 1 -2.5 3e-3\n8 4 5 6\n",
            "2\nnames and further columns\nH 1 -2.5 3e-3 7\nO 4 5 6 8\n",
            "1.0, -2.5, 3e-3;\n4, 5, 6;",
            "1,0;-2,5;3e-3\n4;5,0;6",
            "\u{feff}1\t-2.5\t3e-3\t1000\n4 5 6 1000",
        ] {
            assert_eq!(text(given).unwrap(), points, "{given}");
        }
    }

    #[test]
    fn utf_16_is_told_from_numbers() {
        let text = "# água\r\n1 2 3\r\n";
        let units = || std::iter::once(0xfeff).chain(text.encode_utf16());
        let little: Vec<u8> = units().flat_map(u16::to_le_bytes).collect();
        let big: Vec<u8> = units().flat_map(u16::to_be_bytes).collect();
        assert_eq!(utf_16(&little).as_deref(), Some(text));
        assert_eq!(utf_16(&big).as_deref(), Some(text));
        let number = f32::from_le_bytes([0xff, 0xfe, 0x80, 0x3f]);
        assert_eq!(utf_16(bytemuck::bytes_of(&[number, 2.0, 3.0])), None);
        assert_eq!(utf_16(text.as_bytes()), None);
    }

    #[test]
    fn a_malformed_point_is_reported_with_its_line() {
        assert!(text("1 2 3\n4 five 6").unwrap_err().contains("line 2"));
        assert!(text("1 2").unwrap_err().contains("line 1"));
        assert!(text("3\nwater\nH 1 2 3").unwrap_err().contains("declares 3"));
        assert!(text("nan 2 3").unwrap()[0][0].is_nan());
    }
}
