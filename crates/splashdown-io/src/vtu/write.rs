//! The writer: declarations in XML, then the bytes of all arrays.

use std::io::{self, Write};

use crate::data::{Attribute, Particles};

/// Numbers of generated connectivity per write.
const CHUNK: usize = 4096;

/// `VTK_VERTEX` among VTK's cell types.
const VTK_VERTEX: u8 = 1;

/// Writes particles to `out`. Attributes that are present become the point arrays `velocity`, `density`, `pressure` and
/// `id`, other attributes those of their names.
///
/// # Errors
/// Those of `out`; `InvalidInput` if [`Particles::check`] fails.
pub fn write_particles_to(out: &mut dyn Write, particles: &Particles) -> io::Result<()> {
    particles.check()?;
    let count = particles.len();
    let names: Vec<String> = particles.other_attributes().map(xml_name).collect();
    let others = particles
        .other_attributes()
        .zip(&names)
        .map(|(attribute, name)| Array::of(name, "Float32", attribute.components as u32, &attribute.values));
    let point_data = [
        Array::of("velocity", "Float32", 3, &particles.velocities),
        Array::of("density", "Float32", 1, &particles.densities),
        Array::of("pressure", "Float32", 1, &particles.pressures),
        Array::of("id", "UInt32", 1, &particles.ids),
    ];
    let point_data: Vec<_> = point_data.into_iter().filter(|array| array.bytes() > 0).chain(others).collect();
    let points = Array::of("Points", "Float32", 3, &particles.positions);
    let cells = [
        Array { name: "connectivity", kind: "Int32", components: 1, data: Data::Range { first: 0, count } },
        Array { name: "offsets", kind: "Int32", components: 1, data: Data::Range { first: 1, count } },
        Array {
            name: "types",
            kind: "UInt8",
            components: 1,
            data: Data::Repeat { value: VTK_VERTEX, count },
        },
    ];

    let mut offset = 0;
    writeln!(
        out,
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" \
         header_type=\"UInt64\">\n<UnstructuredGrid>\n<Piece NumberOfPoints=\"{count}\" NumberOfCells=\"{count}\">"
    )?;
    writeln!(out, "<PointData>")?;
    for array in &point_data {
        array.declare(out, &mut offset)?;
    }
    writeln!(out, "</PointData>\n<Points>")?;
    points.declare(out, &mut offset)?;
    writeln!(out, "</Points>\n<Cells>")?;
    for array in &cells {
        array.declare(out, &mut offset)?;
    }
    // Offsets are relative to the byte after the underscore.
    write!(out, "</Cells>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_")?;
    for array in point_data.iter().chain([&points]).chain(&cells) {
        array.append(out)?;
    }
    writeln!(out, "\n</AppendedData>\n</VTKFile>")
}

/// The name of an attribute without characters that have a meaning in XML.
fn xml_name(attribute: &Attribute) -> String {
    attribute.word().replace(['<', '>', '&', '"'], "_")
}

/// An array of the file: declared in the XML, appended after it.
struct Array<'a> {
    name: &'a str,
    kind: &'static str,
    components: u32,
    data: Data<'a>,
}

/// The bytes of an array, or how to generate them, so that cell arrays need no memory.
enum Data<'a> {
    Bytes(&'a [u8]),
    Range { first: i32, count: usize },
    Repeat { value: u8, count: usize },
}

impl<'a> Array<'a> {
    fn of<T: bytemuck::NoUninit>(
        name: &'a str,
        kind: &'static str,
        components: u32,
        values: &'a [T],
    ) -> Self {
        Self { name, kind, components, data: Data::Bytes(bytemuck::cast_slice(values)) }
    }

    fn bytes(&self) -> u64 {
        match self.data {
            Data::Bytes(data) => data.len() as u64,
            Data::Range { count, .. } => 4 * count as u64,
            Data::Repeat { count, .. } => count as u64,
        }
    }

    fn declare(&self, out: &mut dyn Write, offset: &mut u64) -> io::Result<()> {
        let Self { name, kind, .. } = self;
        write!(out, "<DataArray type=\"{kind}\" Name=\"{name}\"")?;
        // A single component is omitted, as VTK does: `meshio` reads an explicit 1 as a matrix of one column.
        if self.components > 1 {
            write!(out, " NumberOfComponents=\"{}\"", self.components)?;
        }
        writeln!(out, " format=\"appended\" offset=\"{offset}\"/>")?;
        *offset += size_of::<u64>() as u64 + self.bytes();
        Ok(())
    }

    fn append(&self, out: &mut dyn Write) -> io::Result<()> {
        out.write_all(&self.bytes().to_le_bytes())?;
        match self.data {
            Data::Bytes(data) => out.write_all(data),
            Data::Range { first, count } => {
                let mut chunk = [0_i32; CHUNK];
                for start in (0..count).step_by(CHUNK) {
                    let length = CHUNK.min(count - start);
                    for (i, value) in chunk[..length].iter_mut().enumerate() {
                        *value = first + (start + i) as i32;
                    }
                    out.write_all(bytemuck::cast_slice(&chunk[..length]))?;
                }
                Ok(())
            }
            Data::Repeat { value, count } => {
                let chunk = [value; CHUNK];
                for start in (0..count).step_by(CHUNK) {
                    out.write_all(&chunk[..CHUNK.min(count - start)])?;
                }
                Ok(())
            }
        }
    }
}
