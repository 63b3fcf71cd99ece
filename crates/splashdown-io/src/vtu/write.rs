//! The writers: declarations in XML, then the bytes of all arrays.

use std::io::{self, Write};

use super::arrays::{Array, Data, xml_name};
use crate::data::{Mesh, Particles};

/// `VTK_VERTEX` among VTK's cell types.
const VTK_VERTEX: u8 = 1;

/// Writes particles to `out` as an unstructured grid. Attributes that are present become the point arrays `velocity`,
/// `density`, `pressure` and `id`, other attributes those of their names. Time and particle spacing are the arrays
/// `TimeValue` and `particle_spacing` of the field data.
///
/// # Errors
/// Those of `out`; `InvalidInput` if [`Particles::check`] fails.
pub fn write_particles_to(out: &mut dyn Write, particles: &Particles) -> io::Result<()> {
    let count = particles.len();
    let [connectivity, ends] = single_points(count);
    let types = Array::generated("types", "UInt8", Data::Repeat { value: VTK_VERTEX, count });
    let cells = Cells { section: "Cells", number: "NumberOfCells", count };
    write_particles(out, particles, "UnstructuredGrid", cells, &[connectivity, ends, types])
}

/// Writes particles to `out` as poly data (`.vtp`), with the arrays of [`write_particles_to`].
///
/// # Errors
/// Those of `out`; `InvalidInput` if [`Particles::check`] fails.
pub fn write_poly_particles_to(out: &mut dyn Write, particles: &Particles) -> io::Result<()> {
    let count = particles.len();
    let cells = Cells { section: "Verts", number: "NumberOfVerts", count };
    write_particles(out, particles, "PolyData", cells, &single_points(count))
}

/// Writes a mesh to `out` as poly data (`.vtp`). Normals and velocities that are present become the point arrays
/// `normals` and `velocity`, other attributes those of their names.
///
/// # Errors
/// Those of `out`; `InvalidInput` if [`Mesh::check`] fails.
pub fn write_mesh_to(out: &mut dyn Write, mesh: &Mesh) -> io::Result<()> {
    mesh.check()?;
    let names: Vec<String> = mesh.attributes.iter().map(xml_name).collect();
    let others =
        mesh.attributes.iter().zip(&names).map(|(attribute, name)| Array::of_attribute(name, attribute));
    let known = [
        Array::of("normals", "Float32", 3, &mesh.normals),
        Array::of("velocity", "Float32", 3, &mesh.velocities),
    ];
    let count = mesh.len();
    let triangles = [
        // The check has bounded the vertex numbers.
        Array::of("connectivity", "Int32", 1, &mesh.triangles),
        Array::generated("offsets", "Int64", Data::Ends { corners: 3, count }),
    ];
    Grid {
        kind: "PolyData",
        count: mesh.vertices.len(),
        cells: Cells { section: "Polys", number: "NumberOfPolys", count },
        // VTK shades with the array that is declared to be the normals.
        active: if mesh.normals.is_empty() { "" } else { " Normals=\"normals\"" },
        field: &[],
        point_data: &known.into_iter().filter(|array| array.bytes() > 0).chain(others).collect::<Vec<_>>(),
        points: Array::of("Points", "Float32", 3, &mesh.vertices),
        arrays: &triangles,
    }
    .write(out)
}

/// Connectivity and offsets of cells of one point each.
fn single_points(count: usize) -> [Array<'static>; 2] {
    [("connectivity", 0), ("offsets", 1)]
        .map(|(name, first)| Array::generated(name, "Int32", Data::Range { first, count }))
}

fn write_particles(
    out: &mut dyn Write,
    particles: &Particles,
    kind: &'static str,
    cells: Cells,
    arrays: &[Array<'_>],
) -> io::Result<()> {
    particles.check()?;
    let names: Vec<String> = particles.other_attributes().map(xml_name).collect();
    let others = particles
        .other_attributes()
        .zip(&names)
        .map(|(attribute, name)| Array::of_attribute(name, attribute));
    let known = [
        Array::of("velocity", "Float32", 3, &particles.velocities),
        Array::of("density", "Float32", 1, &particles.densities),
        Array::of("pressure", "Float32", 1, &particles.pressures),
        Array::of("id", "UInt32", 1, &particles.ids),
    ];
    let fields = particles.info.fields().into_iter();
    let field: Vec<_> =
        fields.map(|(name, value)| Array::generated(name, "Float64", Data::Number(value))).collect();
    Grid {
        kind,
        count: particles.len(),
        cells,
        active: "",
        field: &field,
        point_data: &known
            .into_iter()
            .filter(|array| particles.has(array.bytes() as usize))
            .chain(others)
            .collect::<Vec<_>>(),
        points: Array::of("Points", "Float32", 3, &particles.positions),
        arrays,
    }
    .write(out)
}

/// The section of the cells, and the attribute of the piece with their number.
#[derive(Clone, Copy)]
struct Cells {
    section: &'static str,
    number: &'static str,
    count: usize,
}

/// A file of one piece.
struct Grid<'a> {
    kind: &'static str,
    /// Number of points.
    count: usize,
    cells: Cells,
    /// XML attributes of the point data.
    active: &'static str,
    /// Single numbers.
    field: &'a [Array<'a>],
    point_data: &'a [Array<'a>],
    points: Array<'a>,
    /// The arrays of the cells.
    arrays: &'a [Array<'a>],
}

impl Grid<'_> {
    fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        let Self { kind, count, cells, active, field, point_data, points, arrays } = self;
        let Cells { section, number, count: cells } = cells;
        let mut offset = 0;
        writeln!(
            out,
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"{kind}\" version=\"1.0\" byte_order=\"LittleEndian\" \
             header_type=\"UInt64\">\n<{kind}>"
        )?;
        if !field.is_empty() {
            writeln!(out, "<FieldData>")?;
            for array in *field {
                array.declare(out, &mut offset, " NumberOfTuples=\"1\"")?;
            }
            writeln!(out, "</FieldData>")?;
        }
        writeln!(out, "<Piece NumberOfPoints=\"{count}\" {number}=\"{cells}\">\n<PointData{active}>")?;
        for array in *point_data {
            array.declare(out, &mut offset, "")?;
        }
        writeln!(out, "</PointData>\n<Points>")?;
        points.declare(out, &mut offset, "")?;
        writeln!(out, "</Points>\n<{section}>")?;
        for array in *arrays {
            array.declare(out, &mut offset, "")?;
        }
        // Offsets are relative to the byte after the underscore.
        write!(out, "</{section}>\n</Piece>\n</{kind}>\n<AppendedData encoding=\"raw\">\n_")?;
        for array in field.iter().chain(*point_data).chain([points]).chain(*arrays) {
            array.append(out)?;
        }
        writeln!(out, "\n</AppendedData>\n</VTKFile>")
    }
}
