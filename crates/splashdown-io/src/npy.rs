//! NPY, numpy's array file: a reader of positions, and the parts shared with NPZ.
//!
//! *Why own code:* the crates read every type and shape through traits and `ndarray`, but rows of numbers need only a
//! header and a cast. Format: numpy.lib.format, versions 1 to 3.

use std::path::Path;

use crate::data::Particles;
use crate::data::columns::{Wanted, triples};
use crate::error::IoError;
use crate::input::content;
use crate::number::Number;

/// Reads positions from a little-endian float32 or float64 array of shape (N, 3) in C order.
///
/// # Errors
/// [`IoError::Read`]; [`IoError::Malformed`] if the array has another type or shape, or the file is cut short.
pub fn read_positions(path: &Path) -> Result<Vec<[f32; 3]>, IoError> {
    let bytes = content(path)?;
    parse(&bytes).map_err(|reason| IoError::malformed(path, "NPY", reason))
}

pub(crate) fn read(path: &Path, _: Wanted) -> Result<Particles, IoError> {
    Ok(Particles::from_positions(read_positions(path)?))
}

fn parse(bytes: &[u8]) -> Result<Vec<[f32; 3]>, String> {
    let (header, data) = split(bytes)?;
    let array = Layout::of(&header)?;
    let [count, 3] = array.shape[..] else {
        return Err(format!("its shape is {}, only (N, 3) is read", array.shape_in_words()));
    };
    let data = array.data(data)?;
    match array.number {
        Number::F32 => Ok(data.chunks_exact(12).map(bytemuck::pod_read_unaligned).collect()),
        Number::F64 => Ok(triples(&Number::F64.decode(data, false)).collect()),
        _ => Err(format!(
            "its {count} rows are of type '<{}', only '<f4' and '<f8' (floats) are read",
            array.kind
        )),
    }
}

/// Type and shape of an array.
#[derive(Debug)]
pub(crate) struct Layout {
    pub(crate) number: Number,
    /// Letter and size of the type, as in numpy.
    kind: String,
    /// Sizes of the axes, the outermost first.
    pub(crate) shape: Vec<usize>,
}

impl Layout {
    /// Reads a header, which is a Python dictionary.
    pub(crate) fn of(header: &str) -> Result<Self, String> {
        let given = first_word(value(header, "descr")?).trim();
        let kind = given.trim_matches('\'');
        // A single byte has no byte order.
        let kind = kind.strip_prefix('<').or_else(|| kind.strip_prefix('|')).unwrap_or(kind);
        let number = match kind {
            "i1" => Number::I8,
            "u1" => Number::U8,
            "i2" => Number::I16,
            "u2" => Number::U16,
            "i4" => Number::I32,
            "u4" => Number::U32,
            "i8" => Number::I64,
            "u8" => Number::U64,
            "f4" => Number::F32,
            "f8" => Number::F64,
            _ => {
                return Err(format!(
                    "its type is {given:.24}, only little-endian integers of 1 to 8 bytes and floats of 4 or 8 bytes are read"
                ));
            }
        };
        if !value(header, "fortran_order")?.starts_with("False") {
            return Err("it is in Fortran order; save it with numpy.ascontiguousarray".to_owned());
        }
        let shape = value(header, "shape")?;
        let shape = shape.split_once(')').map_or(shape, |(inside, _)| inside).trim_start_matches('(');
        let sizes = shape.split(',').map(str::trim).filter(|size| !size.is_empty());
        let sizes: Result<Vec<usize>, _> = sizes.map(str::parse).collect();
        let shape = sizes.map_err(|_| format!("its shape ({shape:.60}) is too large or not a shape"))?;
        Ok(Self { number, kind: kind.to_owned(), shape })
    }

    /// Size of all numbers, in bytes.
    pub(crate) fn bytes(&self) -> Result<usize, String> {
        let product = self.shape.iter().try_fold(self.number.size(), |size, &axis| size.checked_mul(axis));
        product.ok_or_else(|| format!("its shape {} is too large", self.shape_in_words()))
    }

    /// The bytes of the numbers. Further bytes may follow them in `data`.
    pub(crate) fn data<'a>(&self, data: &'a [u8]) -> Result<&'a [u8], String> {
        let wanted = self.bytes()?;
        data.get(..wanted).ok_or_else(|| {
            let (shape, given) = (self.shape_in_words(), data.len());
            format!("its shape {shape} needs {wanted} bytes, but {given} follow the header: it was cut short")
        })
    }

    /// The type as in numpy, e.g. `<f4`.
    pub(crate) fn kind(&self) -> String {
        format!("<{}", self.kind)
    }

    pub(crate) fn shape_in_words(&self) -> String {
        let sizes: Vec<String> = self.shape.iter().map(usize::to_string).collect();
        match &sizes[..] {
            [one] => format!("({one},)"),
            _ => format!("({})", sizes.join(", ")),
        }
    }
}

/// Splits a file into its header and its data.
pub(crate) fn split(bytes: &[u8]) -> Result<(String, &[u8]), String> {
    let cut = || "it was cut short inside its header".to_owned();
    let rest =
        bytes.strip_prefix(b"\x93NUMPY").ok_or("it does not begin with the signature of an NPY file")?;
    let (&[major, _minor], rest) = rest.split_first_chunk().ok_or_else(cut)?;
    let (length, rest) = match major {
        1 => rest.split_first_chunk().map(|(size, rest)| (u64::from(u16::from_le_bytes(*size)), rest)),
        2 | 3 => rest.split_first_chunk().map(|(size, rest)| (u64::from(u32::from_le_bytes(*size)), rest)),
        _ => return Err(format!("its format version is {major}, only versions 1 to 3 are read")),
    }
    .ok_or_else(cut)?;
    let length = usize::try_from(length).map_err(|_| cut())?;
    let (header, data) = rest.split_at_checked(length).ok_or_else(cut)?;
    Ok((String::from_utf8_lossy(header).into_owned(), data))
}

/// The shape of an array of rows. An array of one column has one axis.
pub(crate) fn shape(rows: usize, columns: usize) -> String {
    if columns == 1 { format!("({rows},)") } else { format!("({rows}, {columns})") }
}

/// The header of an array of a type (`<f4`, `<u4`) and a shape, given as in Python: `(5, 3)`, `(5,)`, `()`.
pub(crate) fn header(kind: &str, shape: &str) -> Vec<u8> {
    let mut header = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}");
    // Signature, version and length have ten bytes; a line feed ends the header; the data begins at a multiple of 64.
    let padded = (10 + header.len() + 1).next_multiple_of(64) - 10;
    header.extend(std::iter::repeat_n(' ', padded - header.len() - 1));
    [b"\x93NUMPY\x01\x00", &(padded as u16).to_le_bytes()[..], header.as_bytes(), b"\n"].concat()
}

/// The text after `'key':` in the header.
fn value<'a>(header: &'a str, key: &str) -> Result<&'a str, String> {
    let after = header.split_once(&format!("'{key}'")).map(|(_, after)| after.trim_start());
    let value = after.and_then(|after| after.strip_prefix(':'));
    value.map(str::trim_start).ok_or_else(|| format!("its header has no key '{key}'"))
}

fn first_word(text: &str) -> &str {
    text.split(',').next().unwrap_or(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(header: &str, data: &[f32]) -> Vec<u8> {
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend((header.len() as u16).to_le_bytes());
        bytes.extend(header.as_bytes());
        bytes.extend(data.iter().flat_map(|v| v.to_le_bytes()));
        bytes
    }

    const GOOD: &str = "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), }\n";

    #[test]
    fn positions_are_read() {
        let data = [1.0, 2.0, 3.0, -4.0, 5.5, 6.0];
        assert_eq!(parse(&file(GOOD, &data)).unwrap(), [[1.0, 2.0, 3.0], [-4.0, 5.5, 6.0]]);
        let mut doubles = file(&GOOD.replace("<f4", "<f8"), &[]);
        doubles.extend(data.iter().flat_map(|&v| f64::from(v).to_le_bytes()));
        assert_eq!(parse(&doubles).unwrap(), [[1.0, 2.0, 3.0], [-4.0, 5.5, 6.0]]);
    }

    #[test]
    fn the_written_header_is_aligned_and_is_read() {
        let data = [1.0_f32, 2.0, 3.0, -4.0, 5.5, 6.0];
        let mut bytes = header("<f4", "(2, 3)");
        bytes.extend_from_slice(bytemuck::cast_slice(&data));
        assert_eq!(bytes.len() - 24, 128);
        assert_eq!(parse(&bytes).unwrap(), [[1.0, 2.0, 3.0], [-4.0, 5.5, 6.0]]);
    }

    #[test]
    fn other_types_and_shapes_are_refused() {
        let six = [0.0; 6];
        for (bytes, reason) in [
            (b"PK\x03\x04".to_vec(), "signature"),
            (file(GOOD, &six[..5]), "cut short"),
            (file(&GOOD.replace("<f4", "<f8"), &six), "cut short"),
            (file(&GOOD.replace("<f4", "<i4"), &six), "'<i4'"),
            (file(&GOOD.replace("<f4", "<c8"), &six), "'<c8'"),
            (file(&GOOD.replace("<f4", ">f4"), &six), "'>f4'"),
            (file(&GOOD.replace("False", "True"), &six), "Fortran"),
            (file(&GOOD.replace("(2, 3)", "(6,)"), &six), "(6,)"),
            (file(&GOOD.replace("(2, 3)", "(9999999999999999999, 3)"), &six), "shape"),
            (file(&GOOD.replace("(2, 3)", "(99999999999999999, 3)"), &six), "cut short"),
            (file(&GOOD.replace("'shape'", "'form'"), &six), "'shape'"),
            (file(GOOD, &six)[..20].to_vec(), "cut short"),
        ] {
            let message = parse(&bytes).unwrap_err();
            assert!(message.contains(reason), "{message}");
        }
    }
}
