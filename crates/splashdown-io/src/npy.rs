//! NPY, numpy's array file: a reader for positions, i.e. float32 (N, 3).
//!
//! *Why own code:* the crates read every type and shape through traits and `ndarray`; one type and one shape is a
//! header and a cast. Format: numpy.lib.format, versions 1 to 3.

use std::fs;
use std::path::Path;

use crate::error::IoError;

/// Reads a little-endian float32 array of shape (N, 3) in C order.
///
/// # Errors
/// [`IoError::Read`]; [`IoError::Malformed`] where the file is another type or shape, or cut short.
pub fn read_positions(path: &Path) -> Result<Vec<[f32; 3]>, IoError> {
    let bytes = fs::read(path).map_err(|error| IoError::read(path, &error))?;
    parse(&bytes).map_err(|reason| IoError::malformed(path, "NPY", reason))
}

fn parse(bytes: &[u8]) -> Result<Vec<[f32; 3]>, String> {
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
    let header = String::from_utf8_lossy(header);

    let kind = value(&header, "descr")?;
    if !kind.starts_with("'<f4'") {
        return Err(format!("its type is {}, only '<f4' (float32) is read", first_word(kind)));
    }
    if !value(&header, "fortran_order")?.starts_with("False") {
        return Err("it is in Fortran order; save it with numpy.ascontiguousarray".to_owned());
    }
    let shape = value(&header, "shape")?;
    let shape = shape.split_once(')').map_or(shape, |(inside, _)| inside).trim_start_matches('(');
    let sizes: Vec<usize> = shape.split(',').filter_map(|size| size.trim().parse().ok()).collect();
    let [count, 3] = sizes[..] else {
        return Err(format!("its shape is ({shape}), only (N, 3) is read"));
    };
    let wanted = count.checked_mul(12).ok_or("its shape is too large")?;
    if data.len() < wanted {
        return Err(format!(
            "{count} rows need {wanted} bytes, but {} follow the header: it was cut short",
            data.len()
        ));
    }
    Ok(data[..wanted].chunks_exact(12).map(bytemuck::pod_read_unaligned).collect())
}

/// What follows `'key':` in the header, which is a Python dictionary.
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
    }

    #[test]
    fn what_is_not_float32_rows_of_three_is_refused_with_the_reason() {
        let six = [0.0; 6];
        for (bytes, reason) in [
            (b"PK\x03\x04".to_vec(), "mark"),
            (file(GOOD, &six[..5]), "cut short"),
            (file(&GOOD.replace("<f4", "<f8"), &six), "'<f8'"),
            (file(&GOOD.replace("<f4", ">f4"), &six), "'>f4'"),
            (file(&GOOD.replace("False", "True"), &six), "Fortran"),
            (file(&GOOD.replace("(2, 3)", "(6,)"), &six), "(6,)"),
            (file(&GOOD.replace("(2, 3)", "(9999999999999999999, 3)"), &six), "shape"),
            (file(&GOOD.replace("'shape'", "'form'"), &six), "'shape'"),
            (file(GOOD, &six)[..20].to_vec(), "cut short"),
        ] {
            let message = parse(&bytes).unwrap_err();
            assert!(message.contains(reason), "{message}");
        }
    }
}
