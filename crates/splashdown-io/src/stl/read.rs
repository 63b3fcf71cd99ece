//! The reader of text and binary files.

use std::path::Path;

use crate::data::Mesh;
use crate::error::IoError;
use crate::input::{Welder, content};

/// Size of the header of a binary file: 80 bytes of free text and the number of triangles.
const HEADER: usize = 84;
/// Size of a triangle in a binary file: normal, three corners and two unused bytes.
const TRIANGLE: usize = 50;

pub(crate) fn read_mesh(path: &Path) -> Result<Mesh, IoError> {
    let bytes = content(path)?;
    let mesh = if is_text(&bytes) { text(&bytes) } else { binary(&bytes) };
    mesh.map_err(|reason| IoError::malformed(path, "STL", reason))
}

/// Number of triangles and size of a binary file, as its header declares them.
fn declared(bytes: &[u8]) -> Option<(u32, usize)> {
    let count = u32::from_le_bytes(*bytes.get(80..HEADER)?.first_chunk()?);
    Some((count, (count as usize).checked_mul(TRIANGLE)?.checked_add(HEADER)?))
}

/// Whether the file is text. The first word is not sufficient, because many programs write `solid` into the header of
/// binary files.
fn is_text(bytes: &[u8]) -> bool {
    if declared(bytes).is_some_and(|(_, size)| size == bytes.len()) {
        return false;
    }
    let start = bytes.trim_ascii_start();
    let solid = start.get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    solid && !start[..start.len().min(1024)].contains(&0)
}

fn binary(bytes: &[u8]) -> Result<Mesh, String> {
    let Some((count, size)) = declared(bytes) else {
        return Err(format!(
            "it does not begin with `solid`, as text files do, and its {} bytes are fewer than the {HEADER} of a binary header",
            bytes.len()
        ));
    };
    if bytes.len() < size {
        return Err(format!(
            "its header declares {count} triangles, which need {size} bytes, but the file has {}: it was cut short, or is not an STL file",
            bytes.len()
        ));
    }
    let mut welder = Welder::default();
    for row in bytes[HEADER..size].chunks_exact(TRIANGLE) {
        // The normal at the start of the row is ignored, because it follows from the corners.
        welder.triangle(bytemuck::pod_read_unaligned(&row[12..48]));
    }
    Ok(welder.into_mesh())
}

fn text(bytes: &[u8]) -> Result<Mesh, String> {
    let mut welder = Welder::default();
    let (mut corners, mut inside, mut ended) = (Vec::<[f32; 3]>::new(), false, true);
    for (number, line) in bytes.split(|&byte| byte == b'\n').enumerate() {
        let line = String::from_utf8_lossy(line);
        let mut words = line.split_ascii_whitespace();
        let Some(keyword) = words.next() else { continue };
        let wrong = |reason: &str| Err(format!("line {}: {reason}", number + 1));
        match keyword.to_ascii_lowercase().as_str() {
            "solid" => ended = false,
            "endsolid" => ended = true,
            "facet" if inside => return wrong("a facet begins inside another"),
            "facet" => inside = true,
            "outer" | "endloop" => {}
            "vertex" if !inside => return wrong("a vertex outside of any facet"),
            "vertex" => {
                let numbers: Option<Vec<f32>> = words.map(|word| word.parse().ok()).collect();
                let Some(Ok(corner)) = numbers.map(<[f32; 3]>::try_from) else {
                    return wrong("a vertex needs three numbers");
                };
                corners.push(corner);
            }
            "endfacet" => {
                let Ok(triangle) = <[[f32; 3]; 3]>::try_from(corners.as_slice()) else {
                    return wrong(&format!("a facet with {} corners, 3 are needed", corners.len()));
                };
                welder.triangle(triangle);
                corners.clear();
                inside = false;
            }
            _ => {
                return wrong(&format!("`{keyword:.24}` is not a keyword of STL"));
            }
        }
    }
    if inside || !ended {
        return Err("it ends without `endsolid`: it was cut short".to_owned());
    }
    Ok(welder.into_mesh())
}
