//! The reader of meshes: points and polygons of poly data. Other cells and the data of points and cells are not read.

use std::path::Path;

use roxmltree::Node;

use super::file::{Arrays, count_of, data_arrays, open};
use crate::data::Mesh;
use crate::data::columns::triples;
use crate::error::IoError;
use crate::input::{MAX_COUNT, content, push_polygons};
use crate::number::wholes;

pub(crate) fn read_mesh(path: &Path) -> Result<Mesh, IoError> {
    let bytes = content(path)?;
    let mesh = open(&bytes, &["PolyData"], |root, arrays| {
        let mut mesh = Mesh::default();
        let pieces = root.descendants().filter(|node| node.has_tag_name("Piece"));
        pieces.into_iter().try_for_each(|piece| add(piece, arrays, &mut mesh))?;
        Ok(mesh)
    });
    mesh.map_err(|reason| IoError::malformed(path, "VTP", reason))
}

/// Adds a piece to the mesh.
fn add(piece: Node<'_, '_>, arrays: &Arrays<'_>, mesh: &mut Mesh) -> Result<(), String> {
    if count_of(piece, "NumberOfStrips")? > 0 {
        return Err("its triangles form strips, which are not read: save them as polygons".to_owned());
    }
    let (points, polygons) = (count_of(piece, "NumberOfPoints")?, count_of(piece, "NumberOfPolys")?);
    let before = mesh.vertices.len();
    if before + points > MAX_COUNT {
        return Err(format!("its pieces have more than {MAX_COUNT} points"));
    }
    if points > 0 {
        let array = data_arrays(piece, "Points").next().ok_or("its piece has no array of points")?;
        mesh.vertices.extend(triples(&arrays.values(array, points, 3)?));
    }
    if polygons > 0 {
        let array = |name: &str| {
            let mut all = data_arrays(piece, "Polys");
            let found = all.find(|array| array.attribute("Name") == Some(name));
            found.ok_or_else(|| format!("its polygons have no array `{name}`"))
        };
        let ends = wholes(&arrays.values(array("offsets")?, polygons, 1)?, "count")?;
        let corners = ends.last().copied().unwrap_or_default() as usize;
        let mut corners = wholes(&arrays.values(array("connectivity")?, corners, 1)?, "vertex number")?;
        for corner in &mut corners {
            if *corner as usize >= points {
                return Err(format!("vertex number {corner} is out of range: its piece has {points} points"));
            }
            // The sum is below `MAX_COUNT`.
            *corner += before as u32;
        }
        push_polygons(&mut mesh.triangles, &corners, &ends, |_| true)?;
    }
    Ok(())
}
