//! The reader of positions and faces.

use std::borrow::Cow;
use std::path::Path;

use crate::data::Mesh;
use crate::error::IoError;
use crate::input::{content, push_fan};

pub(crate) fn read_mesh(path: &Path) -> Result<Mesh, IoError> {
    parse(&content(path)?).map_err(|reason| IoError::malformed(path, "OBJ", reason))
}

fn parse(bytes: &[u8]) -> Result<Mesh, String> {
    if let Some(at) = bytes.iter().position(|&byte| byte == 0) {
        return Err(format!("it is not text (a zero byte at offset {at})"));
    }
    let mut mesh = Mesh::default();
    let mut corners = Vec::new();
    // A face may precede its vertices, so the largest vertex number is checked at the end.
    let mut largest = (0, 0);
    let mut count = 0;
    let mut lines = bytes.split(|&byte| byte == b'\n').map(<[u8]>::trim_ascii_end).enumerate();
    while let Some((number, first)) = lines.next() {
        let (mut line, number) = (Cow::Borrowed(first), number + 1);
        count += usize::from(!line.is_empty());
        // A backslash at the end of a line joins it with the next one.
        while line.last() == Some(&b'\\') {
            let whole = line.to_mut();
            whole.pop();
            let Some((_, next)) = lines.next() else { break };
            whole.push(b' ');
            whole.extend_from_slice(next);
        }
        let text = String::from_utf8_lossy(&line);
        let mut words = text.split_ascii_whitespace();
        match words.next() {
            Some("v") => mesh.vertices.push(vertex(words).map_err(|e| format!("line {number}: {e}"))?),
            Some("f") => {
                corners.clear();
                for word in words {
                    let corner =
                        corner(word, mesh.vertices.len()).map_err(|e| format!("line {number}: {e}"))?;
                    corners.push(corner);
                    if u64::from(corner) + 1 > largest.0 {
                        largest = (u64::from(corner) + 1, number);
                    }
                }
                push_fan(&mut mesh.triangles, &corners).map_err(|e| format!("line {number}: {e}"))?;
            }
            _ => {}
        }
    }
    let vertices = mesh.vertices.len();
    let (corner, line) = largest;
    if corner > vertices as u64 {
        return Err(format!(
            "line {line}: a face uses vertex {corner}, but the file has {vertices} vertices (numbered from 1)"
        ));
    }
    if vertices == 0 && mesh.triangles.is_empty() {
        return Err(format!("none of its {count} lines is a vertex (`v x y z`) or a face (`f 1 2 3`)"));
    }
    Ok(mesh)
}

/// Parses three coordinates; a weight or a colour may follow.
fn vertex<'a>(mut words: impl Iterator<Item = &'a str>) -> Result<[f32; 3], String> {
    let mut vertex = [0.0; 3];
    for component in &mut vertex {
        let word = words.next().ok_or("a vertex needs three coordinates")?;
        *component = word.parse().map_err(|_| format!("`{word:.24}` is not a coordinate"))?;
    }
    Ok(vertex)
}

/// The vertex number, from 0, of a corner `vertex/texture/normal`, which counts from 1, or backwards from -1.
fn corner(word: &str, vertices: usize) -> Result<u32, String> {
    let digits = word.split('/').next().unwrap_or(word);
    let given: i64 = digits.parse().map_err(|_| format!("`{word:.24}` is not a vertex number"))?;
    let index = match given {
        0 => return Err("vertex 0: the vertices of an OBJ file are numbered from 1".to_owned()),
        1.. => Some(given - 1),
        // No file has 2^63 vertices.
        _ => given.checked_add(vertices as i64),
    };
    index.and_then(|index| u32::try_from(index).ok()).ok_or_else(|| {
        format!("a face uses vertex {given}, but there are {vertices} vertices up to this line")
    })
}
