//! The reader of meshes: points, and polygons or cells that are polygons. What follows them is not read.

use std::path::Path;

use super::cursor::{Cells, Cursor, count};
use crate::data::Mesh;
use crate::data::columns::triples;
use crate::error::IoError;
use crate::input::{content, push_polygons};

/// The cell types of VTK that are polygons: triangle, polygon and quadrilateral.
const POLYGONS: [f64; 3] = [5.0, 7.0, 9.0];

pub(crate) fn read_mesh(path: &Path) -> Result<Mesh, IoError> {
    let bytes = content(path)?;
    let malformed = |reason| IoError::malformed(path, "VTK", reason);
    let mut file = Cursor::start(&bytes).map_err(malformed)?;
    parse(&mut file).map_err(|reason| malformed(file.located(&reason)))
}

fn parse(file: &mut Cursor<'_>) -> Result<Mesh, String> {
    let mut mesh = Mesh::default();
    let mut cells = Cells { corners: Vec::new(), ends: Vec::new() };
    while let Ok(words) = file.words() {
        let word = |n: usize| words.get(n).map_or("", String::as_str);
        match word(0) {
            "DATASET" => Cursor::check_kind(word(1))?,
            "FIELD" => {
                for _ in 0..count(word(2))? {
                    let array = file.field_array()?;
                    file.skip(array.tuples, array.components, &array.kind)?;
                }
            }
            "METADATA" => file.metadata(),
            "POINTS" => {
                mesh.vertices = triples(&file.numbers(count(word(1))?, 3, word(2))?).collect();
            }
            "CELLS" => cells = file.cells(count(word(1))?, count(word(2))?)?,
            "CELL_TYPES" => {
                let types = file.numbers(count(word(1))?, 1, "int")?;
                let is_polygon = |cell: usize| types.get(cell).is_some_and(|kind| POLYGONS.contains(kind));
                push_polygons(&mut mesh.triangles, &cells.corners, &cells.ends, is_polygon)?;
            }
            "POLYGONS" => {
                let polygons = file.cells(count(word(1))?, count(word(2))?)?;
                push_polygons(&mut mesh.triangles, &polygons.corners, &polygons.ends, |_| true)?;
            }
            "VERTICES" | "LINES" => drop(file.cells(count(word(1))?, count(word(2))?)?),
            "TRIANGLE_STRIPS" => {
                return Err("its triangles form strips, which are not read: save them as polygons".to_owned());
            }
            "POINT_DATA" | "CELL_DATA" => break,
            keyword => return Err(format!("`{keyword:.24}` is not a known keyword")),
        }
    }
    Ok(mesh)
}
