//! A file: its XML, and its arrays as text, base64 or raw bytes, in the XML or after it, with or without zlib compression.

use std::cell::RefCell;

use roxmltree::{Document, Node, ParsingOptions};

use super::decode::{Appended, Encoding, Layout};
use crate::input::MAX_COUNT;
use crate::limit::Budget;
use crate::number::Number;

/// Opens a file of one of these kinds, and reads from its root and arrays.
pub(super) fn open<T>(
    bytes: &[u8],
    kinds: &[&str],
    read: impl FnOnce(Node<'_, '_>, &Arrays<'_>) -> Result<T, String>,
) -> Result<T, String> {
    let (xml, raw) = split(bytes)?;
    let options = ParsingOptions { nodes_limit: 1 << 16, ..ParsingOptions::default() };
    let document = Document::parse_with_options(&xml, options).map_err(|error| error.to_string())?;
    let root = document.root_element();
    let kind = root.attribute("type").unwrap_or_default();
    if !root.has_tag_name("VTKFile") || !kinds.contains(&kind) {
        return Err(format!(
            "it is <{} type=\"{kind}\">; a VTKFile of type {} is read",
            root.tag_name().name(),
            kinds.join(" or ")
        ));
    }
    let layout = Layout {
        big_endian: match root.attribute("byte_order") {
            Some("BigEndian") => true,
            Some("LittleEndian") | None => false,
            Some(order) => return Err(format!("its byte order `{order:.24}` is not known")),
        },
        header: match root.attribute("header_type") {
            Some("UInt64") => Number::U64,
            Some("UInt32") | None => Number::U32,
            Some(kind) => {
                return Err(format!("its header type `{kind:.24}` is not known, only UInt32 and UInt64"));
            }
        },
        is_compressed: match root.attribute("compressor") {
            Some("vtkZLibDataCompressor") => true,
            Some("") | None => false,
            Some(name) => return Err(format!("it is compressed by `{name:.40}`; only zlib is read")),
        },
    };
    let section = root.descendants().find(|node| node.has_tag_name("AppendedData"));
    let appended = match (raw, section) {
        (Some(raw), _) => Some(Appended::Raw(raw)),
        (None, Some(node)) => Some(Appended::base64(node.text().unwrap_or_default())?),
        (None, None) => None,
    };
    let budget = RefCell::new(Budget::of_file(bytes.len() as u64));
    let arrays = Arrays { layout, appended: appended.as_ref(), budget: &budget };
    read(root, &arrays)
}

/// Splits a file into its XML, closed where raw bytes interrupt it, and these bytes, which follow an underscore.
fn split(bytes: &[u8]) -> Result<(String, Option<&[u8]>), String> {
    let find = |from: usize, what: &[u8]| {
        bytes[from..].windows(what.len()).position(|window| window == what).map(|at| from + at)
    };
    let not_text = |_| "its XML is not UTF-8".to_owned();
    let whole = || Ok((std::str::from_utf8(bytes).map_err(not_text)?.to_owned(), None));
    let Some(section) = find(0, b"<AppendedData") else { return whole() };
    let cut = "it was cut short inside the tag <AppendedData>";
    let end = find(section, b">").ok_or(cut)?;
    let tag = std::str::from_utf8(&bytes[section..end]).map_err(not_text)?;
    if !tag.contains("raw") {
        return whole();
    }
    let start = find(end, b"_").ok_or(cut)? + 1;
    let xml = std::str::from_utf8(&bytes[..=end]).map_err(not_text)?;
    Ok((format!("{xml}</AppendedData></VTKFile>"), Some(&bytes[start..])))
}

/// A count in an attribute of a piece; 0 if it is absent.
pub(super) fn count_of(piece: Node<'_, '_>, name: &str) -> Result<usize, String> {
    let given = piece.attribute(name).unwrap_or("0");
    let count =
        given.parse().map_err(|_| format!("{name}: `{given:.24}` is not a number of {}", noun(name)))?;
    if count > MAX_COUNT {
        return Err(format!("its piece has {count} {}, at most {MAX_COUNT} are read", noun(name)));
    }
    Ok(count)
}

/// What an attribute `NumberOfPoints` counts.
fn noun(name: &str) -> String {
    name.trim_start_matches("NumberOf").to_ascii_lowercase()
}

/// The arrays in a section of a piece.
pub(super) fn data_arrays<'a, 'x>(
    piece: Node<'a, 'x>,
    section: &'static str,
) -> impl Iterator<Item = Node<'a, 'x>> {
    let sections = piece.children().filter(move |node| node.has_tag_name(section));
    sections.flat_map(|node| node.children()).filter(|node| node.has_tag_name("DataArray"))
}

/// The arrays of a file.
pub(super) struct Arrays<'a> {
    layout: Layout,
    appended: Option<&'a Appended<'a>>,
    budget: &'a RefCell<Budget>,
}

impl Arrays<'_> {
    /// Reads `rows` x `components` numbers.
    pub(super) fn values(
        &self,
        array: Node<'_, '_>,
        rows: usize,
        components: usize,
    ) -> Result<Vec<f64>, String> {
        let name = array.attribute("Name").unwrap_or("Points");
        let total = rows.checked_mul(components).ok_or_else(|| format!("array `{name}` is too large"))?;
        let read = || -> Result<Vec<f64>, String> {
            let number = number(array.attribute("type").unwrap_or_default())?;
            // Many arrays may refer to the same appended bytes, so the size of the file does not limit their sum.
            self.budget.borrow_mut().take(total.saturating_mul(number.size()) as u64, "it")?;
            let text = array.text().unwrap_or_default();
            let bytes = match array.attribute("format") {
                Some("ascii") | None => {
                    let values: Result<Vec<f64>, _> = text
                        .split_ascii_whitespace()
                        .map(|word| word.parse().map_err(|_| format!("`{word:.24}` is not a number")))
                        .collect();
                    return values;
                }
                Some("binary") => {
                    self.layout.array(text.as_bytes(), Encoding::Base64, total * number.size())?
                }
                Some("appended") => {
                    let given = array.attribute("offset").unwrap_or_default();
                    let offset = given.parse().map_err(|_| format!("`{given:.24}` is not an offset"))?;
                    let appended = self.appended.ok_or("the file has no appended data")?;
                    let (bytes, encoding) = appended.from(offset)?;
                    self.layout.array(bytes, encoding, total * number.size())?
                }
                Some(format) => return Err(format!("its format `{format:.24}` is not known")),
            };
            Ok(number.decode(&bytes, self.layout.big_endian))
        };
        let values = read().map_err(|reason| format!("array `{name}`: {reason}"))?;
        if values.len() != total {
            let given = values.len();
            return Err(format!("array `{name}`: {given} numbers for {rows} points of {components}"));
        }
        Ok(values)
    }
}

fn number(kind: &str) -> Result<Number, String> {
    Ok(match kind {
        "Int8" => Number::I8,
        "UInt8" => Number::U8,
        "Int16" => Number::I16,
        "UInt16" => Number::U16,
        "Int32" => Number::I32,
        "UInt32" => Number::U32,
        "Int64" => Number::I64,
        "UInt64" => Number::U64,
        "Float32" => Number::F32,
        "Float64" => Number::F64,
        _ => return Err(format!("its type `{kind:.24}` is not known")),
    })
}
