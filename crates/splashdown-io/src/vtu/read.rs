//! The reader: arrays as text, base64 or raw bytes, in the XML or after it, with or without zlib compression.

use std::cell::RefCell;
use std::path::Path;

use roxmltree::{Document, Node, ParsingOptions};

use super::decode::{Appended, Encoding, Layout};
use crate::data::columns::{Wanted, triples};
use crate::data::{ParticleInfo, Particles};
use crate::error::IoError;
use crate::input::{MAX_COUNT, content, not_particles};
use crate::limit::Budget;
use crate::number::Number;

pub(crate) fn read(path: &Path, wanted: Wanted) -> Result<Particles, IoError> {
    let bytes = content(path)?;
    let particles = parse(&bytes, wanted).map_err(|reason| IoError::malformed(path, "VTU", reason))?;
    match particles.len() {
        given if given > MAX_COUNT => Err(IoError::TooMany { what: "particles", given, limit: MAX_COUNT }),
        _ => Ok(particles),
    }
}

fn parse(bytes: &[u8], wanted: Wanted) -> Result<Particles, String> {
    let (xml, raw) = split(bytes)?;
    let options = ParsingOptions { nodes_limit: 1 << 16, ..ParsingOptions::default() };
    let document = Document::parse_with_options(&xml, options).map_err(|error| error.to_string())?;
    let root = document.root_element();
    let kind = root.attribute("type").unwrap_or_default();
    if !root.has_tag_name("VTKFile") || !matches!(kind, "UnstructuredGrid" | "PolyData") {
        return Err(format!(
            "it is <{} type=\"{kind}\">; a VTKFile of type UnstructuredGrid or PolyData is read",
            root.tag_name().name()
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
    let mut particles = Particles { info: info(root, &arrays), ..Particles::default() };
    for piece in root.descendants().filter(|node| node.has_tag_name("Piece")) {
        Piece { piece, wanted, arrays: &arrays }.add_to(&mut particles)?;
    }
    Ok(particles)
}

/// Time and particle spacing of the field data; arrays that cannot be read are ignored.
fn info(root: Node<'_, '_>, arrays: &Arrays<'_>) -> ParticleInfo {
    let mut info = ParticleInfo::default();
    let sections = root.descendants().filter(|node| node.has_tag_name("FieldData"));
    for array in sections.flat_map(|section| section.children()) {
        let name = array.attribute("Name").unwrap_or_default();
        if ParticleInfo::has(name) {
            let values = arrays.values(array, 1, 1).unwrap_or_default();
            values.into_iter().for_each(|value| info.set(name, value));
        }
    }
    info
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

/// A piece of the grid with its points.
struct Piece<'a, 'x> {
    piece: Node<'a, 'x>,
    wanted: Wanted,
    arrays: &'a Arrays<'a>,
}

impl Piece<'_, '_> {
    fn add_to(&self, particles: &mut Particles) -> Result<(), String> {
        let given = self.piece.attribute("NumberOfPoints").unwrap_or("0");
        let count: usize = given.parse().map_err(|_| format!("`{given:.24}` is not a number of points"))?;
        if count > MAX_COUNT {
            return Err(format!("its piece has {count} points, at most {MAX_COUNT} are read"));
        }
        let polygons = self.piece.attribute("NumberOfPolys").and_then(|given| given.parse().ok());
        if let Some(polygons) = polygons.filter(|&polygons| polygons > 0) {
            return Err(not_particles(polygons));
        }
        let arrays = |section: &'static str| {
            let sections = self.piece.children().filter(move |node| node.has_tag_name(section));
            sections.flat_map(|node| node.children()).filter(|node| node.has_tag_name("DataArray"))
        };
        if count > 0 {
            let points = arrays("Points").next().ok_or("its piece has no array of points")?;
            let values = self.arrays.values(points, count, 3)?;
            particles.positions.extend(triples(&values));
        }
        for array in arrays("PointData") {
            let name = array.attribute("Name").unwrap_or_default();
            let components = array.attribute("NumberOfComponents").unwrap_or("1").parse().unwrap_or(0);
            if self.wanted.has(name, components) {
                let values = self.arrays.values(array, count, components)?;
                self.wanted.append(particles, name, components, &values)?;
            }
        }
        Ok(())
    }
}

/// The arrays of a file.
struct Arrays<'a> {
    layout: Layout,
    appended: Option<&'a Appended<'a>>,
    budget: &'a RefCell<Budget>,
}

impl Arrays<'_> {
    fn values(&self, array: Node<'_, '_>, rows: usize, components: usize) -> Result<Vec<f64>, String> {
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
