//! The reader of particles.

use std::path::Path;

use roxmltree::Node;

use super::file::{Arrays, count_of, data_arrays, open};
use crate::data::columns::{Wanted, triples};
use crate::data::{ParticleInfo, Particles};
use crate::error::IoError;
use crate::input::{MAX_COUNT, content, not_particles};

pub(crate) fn read(path: &Path, wanted: Wanted) -> Result<Particles, IoError> {
    let bytes = content(path)?;
    let particles = open(&bytes, &["UnstructuredGrid", "PolyData"], |root, arrays| {
        let mut particles = Particles { info: info(root, arrays), ..Particles::default() };
        for piece in root.descendants().filter(|node| node.has_tag_name("Piece")) {
            Piece { piece, wanted, arrays }.add_to(&mut particles)?;
        }
        Ok(particles)
    });
    let is_poly_data = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("vtp"));
    let format = if is_poly_data { "VTP" } else { "VTU" };
    let particles = particles.map_err(|reason| IoError::malformed(path, format, reason))?;
    match particles.len() {
        given if given > MAX_COUNT => Err(IoError::TooMany { what: "particles", given, limit: MAX_COUNT }),
        _ => Ok(particles),
    }
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

/// A piece of the grid with its points.
struct Piece<'a, 'x> {
    piece: Node<'a, 'x>,
    wanted: Wanted,
    arrays: &'a Arrays<'a>,
}

impl Piece<'_, '_> {
    fn add_to(&self, particles: &mut Particles) -> Result<(), String> {
        let count = count_of(self.piece, "NumberOfPoints")?;
        let polygons = self.piece.attribute("NumberOfPolys").and_then(|given| given.parse().ok());
        if let Some(polygons) = polygons.filter(|&polygons| polygons > 0) {
            return Err(not_particles(polygons));
        }
        if count > 0 {
            let points =
                data_arrays(self.piece, "Points").next().ok_or("its piece has no array of points")?;
            let values = self.arrays.values(points, count, 3)?;
            particles.positions.extend(triples(&values));
        }
        for array in data_arrays(self.piece, "PointData") {
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
