//! NPY, numpy's array file: a reader and a writer, and what NPZ needs of both.
//!
//! *Why own code:* the crates read every type and shape through traits and `ndarray`; numbers in rows are a
//! header and a cast. Format: numpy.lib.format, versions 1 to 3.

use std::fs;
use std::path::Path;

use crate::columns::triples;
use crate::error::IoError;
use crate::number::Number;

/// Reads a little-endian float32 or float64 array of shape (N, 3) in C order.
///
/// # Errors
/// [`IoError::Read`]; [`IoError::Malformed`] where the file is another type or shape, or cut short.
pub fn read_positions(path: &Path) -> Result<Vec<[f32; 3]>, IoError> {
    let bytes = fs::read(path).map_err(|error| IoError::read(path, &error))?;
    parse(&bytes).map_err(|reason| IoError::malformed(path, "NPY", reason))
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

/// What an array is.
#[derive(Debug)]
pub(crate) struct Layout {
    pub(crate) number: Number,
    /// The type's letter and size, as numpy writes them.
    kind: String,
    /// Sizes along the axes, the outermost first.
    pub(crate) shape: Vec<usize>,
}

impl Layout {
    /// Reads a header, which is a Python dictionary.
    pub(crate) fn of(header: &str) -> Result<Self, String> {
        let given = first_word(value(header, "descr")?).trim();
        let kind = given.trim_matches('\'');
        // A single byte has no order.
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
                    "its type is {given:.24}, only little-endian floats and integers of the system's sizes are read"
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
        let shape = sizes.map_err(|_| format!("its shape is ({shape:.60}), which is too large or none"))?;
        Ok(Self { number, kind: kind.to_owned(), shape })
    }

    /// Bytes of all numbers.
    pub(crate) fn bytes(&self) -> Result<usize, String> {
        let product = self.shape.iter().try_fold(self.number.size(), |size, &axis| size.checked_mul(axis));
        product.ok_or_else(|| format!("its shape {} is too large", self.shape_in_words()))
    }

    /// The bytes of the numbers, of which there may be more behind.
    pub(crate) fn data<'a>(&self, data: &'a [u8]) -> Result<&'a [u8], String> {
        let wanted = self.bytes()?;
        data.get(..wanted).ok_or_else(|| {
            let (shape, given) = (self.shape_in_words(), data.len());
            format!("its shape {shape} needs {wanted} bytes, but {given} follow the header: it was cut short")
        })
    }

    /// The type as numpy writes it, `<f4` say.
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

/// The header of a file and what follows it.
pub(crate) fn split(bytes: &[u8]) -> Result<(String, &[u8]), String> {
    let cut = || "it was cut short inside its header".to_owned();
    let rest = bytes.strip_prefix(b"\x93NUMPY").ok_or("it does not begin with numpy's mark")?;
    let (&[major, _minor], rest) = rest.split_first_chunk().ok_or_else(cut)?;
    let (length, rest) = match major {
        1 => rest.split_first_chunk().map(|(size, rest)| (u64::from(u16::from_le_bytes(*size)), rest)),
        2 | 3 => rest.split_first_chunk().map(|(size, rest)| (u64::from(u32::from_le_bytes(*size)), rest)),
        _ => return Err(format!("its format version is {major}, versions 1 to 3 are known")),
    }
    .ok_or_else(cut)?;
    let length = usize::try_from(length).map_err(|_| cut())?;
    let (header, data) = rest.split_at_checked(length).ok_or_else(cut)?;
    Ok((String::from_utf8_lossy(header).into_owned(), data))
}

/// What stands before `rows` x `columns` numbers of a type (`<f4`, `<u4`); one column is an array of one axis.
pub(crate) fn header(kind: &str, [rows, columns]: [usize; 2]) -> Vec<u8> {
    let shape = if columns == 1 { format!("({rows},)") } else { format!("({rows}, {columns})") };
    let mut header = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}");
    // Mark, version and length take ten bytes; the data begin at a multiple of 64, and a line's end stands before them.
    let padded = (10 + header.len() + 1).next_multiple_of(64) - 10;
    header.extend(std::iter::repeat_n(' ', padded - header.len() - 1));
    [b"\x93NUMPY\x01\x00", &(padded as u16).to_le_bytes()[..], header.as_bytes(), b"\n"].concat()
}

/// What follows `'key':` in the header.
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
    fn positions_come_back() {
        let data = [1.0, 2.0, 3.0, -4.0, 5.5, 6.0];
        assert_eq!(parse(&file(GOOD, &data)).unwrap(), [[1.0, 2.0, 3.0], [-4.0, 5.5, 6.0]]);
        let mut doubles = file(&GOOD.replace("<f4", "<f8"), &[]);
        doubles.extend(data.iter().flat_map(|&v| f64::from(v).to_le_bytes()));
        assert_eq!(parse(&doubles).unwrap(), [[1.0, 2.0, 3.0], [-4.0, 5.5, 6.0]]);
    }

    #[test]
    fn what_is_written_is_aligned_and_comes_back() {
        let data = [1.0_f32, 2.0, 3.0, -4.0, 5.5, 6.0];
        let mut bytes = header("<f4", [2, 3]);
        bytes.extend_from_slice(bytemuck::cast_slice(&data));
        assert_eq!(bytes.len() - 24, 128);
        assert_eq!(parse(&bytes).unwrap(), [[1.0, 2.0, 3.0], [-4.0, 5.5, 6.0]]);
    }

    #[test]
    fn what_is_not_floats_in_rows_of_three_is_refused_with_the_reason() {
        let six = [0.0; 6];
        for (bytes, reason) in [
            (b"PK\x03\x04".to_vec(), "mark"),
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
