//! The readers: which properties are read and what they mean.

use std::path::Path;

use super::header::{Element, Header, Kind, Property};
use super::rows::{self, Column};
use super::source::Source;
use crate::data::Attribute;
use crate::data::Mesh;
use crate::data::Particles;
use crate::data::columns::Wanted;
use crate::error::IoError;
use crate::input::not_particles;

/// Reads particles from the `vertex` element of a PLY file.
///
/// The properties `x y z` are required; `vx vy vz` (or `velocity_x ..`, `u v w`), `density` (`rho`), `pressure` (`p`)
/// and `id` are read where present. Other elements are ignored, except that a file with faces is refused: the vertices
/// of a mesh are not particles.
///
/// # Errors
/// [`IoError::Read`]; [`IoError::Malformed`], which says what is missing or where the file is wrong.
pub fn read_particles(path: &Path) -> Result<Particles, IoError> {
    read(path, Wanted::Known)
}

pub(crate) fn read(path: &Path, wanted: Wanted) -> Result<Particles, IoError> {
    let source = Source::open(path)?;
    particles(source, wanted).map_err(|reason| IoError::malformed(path, "PLY", reason))
}

/// Reads a mesh from the `vertex` and `face` elements of a PLY file.
///
/// Normals are read where `nx ny nz` are present, velocities where `vx vy vz` are. A polygon becomes a fan of
/// triangles.
///
/// # Errors
/// [`IoError::Read`] or [`IoError::Malformed`]; also for a face with fewer than three corners, or with a vertex number
/// that is out of range.
pub fn read_mesh(path: &Path) -> Result<Mesh, IoError> {
    let source = Source::open(path)?;
    mesh(source).map_err(|reason| IoError::malformed(path, "PLY", reason))
}

fn particles(mut source: Source, wanted: Wanted) -> Result<Particles, String> {
    let header = header(&mut source)?;
    let mut vertices = Vertices::of(&header, |field| match field {
        Some(Field::Normal(_)) | None => wanted == Wanted::All,
        Some(_) => true,
    })?;
    if let Some(faces) = header.element("face").filter(|face| face.count > 0) {
        return Err(not_particles(faces.count));
    }
    for element in &header.elements {
        let is_vertex = element.name == "vertex";
        let columns = if is_vertex { &mut vertices.columns } else { &mut skipped(element) };
        read_rows(&mut source, &header, element, columns)?;
        if is_vertex {
            break;
        }
    }
    let attributes = if wanted == Wanted::All { vertices.attributes() } else { Vec::new() };
    Ok(Particles {
        ids: vertices.ids(),
        positions: vertices.vectors(Field::Position),
        velocities: vertices.vectors(Field::Velocity),
        densities: vertices.scalars(Field::Density),
        pressures: vertices.scalars(Field::Pressure),
        attributes,
        info: header.info,
    })
}

fn mesh(mut source: Source) -> Result<Mesh, String> {
    let header = header(&mut source)?;
    let mut faces = faces(&header)?;
    let wanted = |field| matches!(field, Some(Field::Position(_) | Field::Normal(_) | Field::Velocity(_)));
    let mut vertices = Vertices::of(&header, wanted)?;
    let mut to_read = 2;
    for element in &header.elements {
        let columns = match element.name.as_str() {
            "vertex" => &mut vertices.columns,
            "face" => &mut faces,
            _ => &mut skipped(element),
        };
        read_rows(&mut source, &header, element, columns)?;
        to_read -= usize::from(matches!(element.name.as_str(), "vertex" | "face"));
        if to_read == 0 {
            break;
        }
    }
    let triangles = faces.into_iter().find_map(|column| match column {
        Column::Fans(triangles) => Some(triangles),
        _ => None,
    });
    let mesh = Mesh {
        vertices: vertices.vectors(Field::Position),
        normals: vertices.vectors(Field::Normal),
        velocities: vertices.vectors(Field::Velocity),
        triangles: triangles.unwrap_or_default(),
        attributes: Vec::new(),
    };
    mesh.check().map_err(|error| error.to_string())?;
    Ok(mesh)
}

/// Reads the header and checks that all its elements fit into the file.
fn header(source: &mut Source) -> Result<Header, String> {
    let size = source.left();
    let header = Header::read(source)?;
    for element in &header.elements {
        element.check_size(header.encoding, size)?;
    }
    Ok(header)
}

fn read_rows(
    source: &mut Source,
    header: &Header,
    element: &Element,
    columns: &mut [Column],
) -> Result<(), String> {
    rows::read(source, element, header.encoding, columns)
        .map_err(|reason| format!("in element `{:.24}`: {reason}", element.name))
}

fn skipped(element: &Element) -> Vec<Column> {
    vec![Column::Skipped; element.properties.len()]
}

/// The columns of the faces.
fn faces(header: &Header) -> Result<Vec<Column>, String> {
    let Some(element) = header.element("face") else {
        // Files of points are often mistaken for meshes.
        let points = header
            .element("vertex")
            .map(|vertex| format!(" ({} points): a mesh needs faces too", vertex.count));
        return Err(no_element(header, "face") + &points.unwrap_or_default());
    };
    let is_corners = |property: &Property| {
        matches!(property.name.as_str(), "vertex_indices" | "vertex_index")
            && matches!(property.kind, Kind::List { .. })
    };
    let columns: Vec<Column> = element
        .properties
        .iter()
        .map(|property| if is_corners(property) { Column::Fans(Vec::new()) } else { Column::Skipped })
        .collect();
    if element.count > 0 && !element.properties.iter().any(is_corners) {
        return Err(format!("its faces have no list `vertex_indices`, only: {}", names(&element.properties)));
    }
    Ok(columns)
}

fn no_element(header: &Header, name: &str) -> String {
    let known: Vec<&str> = header.elements.iter().map(|element| element.name.as_str()).collect();
    format!("it has no element `{name}`, only: {:.200}", known.join(", "))
}

fn names(properties: &[Property]) -> String {
    let names: Vec<&str> = properties.iter().map(|property| property.name.as_str()).collect();
    format!("{:.200}", names.join(", "))
}

/// The columns of the `vertex` element.
struct Vertices<'a> {
    properties: &'a [Property],
    columns: Vec<Column>,
}

impl<'a> Vertices<'a> {
    /// Prepares a column for each scalar property whose field is `wanted`.
    fn of(header: &'a Header, wanted: impl Fn(Option<Field>) -> bool) -> Result<Self, String> {
        let element = header.element("vertex").ok_or_else(|| no_element(header, "vertex"))?;
        let column = |property: &Property| match (property.kind, Field::named(&property.name)) {
            (Kind::List { .. }, _) => Column::Skipped,
            (_, field) if !wanted(field) => Column::Skipped,
            (_, Some(Field::Id)) => Column::Integers(Vec::new()),
            _ => Column::Floats(Vec::new()),
        };
        let columns = element.properties.iter().map(column).collect();
        let vertices = Self { properties: &element.properties, columns };
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            if vertices.index(Field::Position(axis)).is_none() {
                let known = names(&element.properties);
                return Err(format!("its vertices have no property `{name}`, only: {known}"));
            }
        }
        Ok(vertices)
    }

    /// The column of a field; the last one if several names mean the same.
    fn index(&self, field: Field) -> Option<usize> {
        let is_field = |(property, column): (&Property, &Column)| {
            *column != Column::Skipped && Field::named(&property.name) == Some(field)
        };
        self.properties.iter().zip(&self.columns).rposition(is_field)
    }

    /// Takes the values of a field; none if it is absent.
    fn scalars(&mut self, field: Field) -> Vec<f32> {
        match self.index(field).map(|index| &mut self.columns[index]) {
            Some(Column::Floats(values)) => std::mem::take(values),
            _ => Vec::new(),
        }
    }

    fn ids(&mut self) -> Vec<u32> {
        match self.index(Field::Id).map(|index| &mut self.columns[index]) {
            Some(Column::Integers(values)) => std::mem::take(values),
            _ => Vec::new(),
        }
    }

    /// Takes the values of three fields; none unless all three are present.
    fn vectors(&mut self, field: fn(usize) -> Field) -> Vec<[f32; 3]> {
        let [x, y, z] = [0, 1, 2].map(|axis| self.scalars(field(axis)));
        x.into_iter().zip(y).zip(z).map(|((x, y), z)| [x, y, z]).collect()
    }

    /// All scalar properties but the position.
    fn attributes(&self) -> Vec<Attribute> {
        let columns = self.properties.iter().zip(&self.columns).filter_map(|(property, column)| {
            let values = match column {
                _ if matches!(Field::named(&property.name), Some(Field::Position(_))) => return None,
                Column::Floats(values) => values.clone(),
                Column::Integers(values) => values.iter().map(|&value| value as f32).collect(),
                Column::Skipped | Column::Fans(_) => return None,
            };
            Some(Attribute { name: property.name.clone(), components: 1, values })
        });
        joined(columns.collect())
    }
}

/// Joins three consecutive scalars named `a_x a_y a_z`, or `vx vy vz`, into a vector.
fn joined(columns: Vec<Attribute>) -> Vec<Attribute> {
    let mut attributes = Vec::new();
    let mut rest = columns.as_slice();
    while let [first, others @ ..] = rest {
        let vector = rest.split_first_chunk().and_then(|([x, y, z], others)| {
            let name = vector_name([&x.name, &y.name, &z.name])?;
            let rows = x.values.iter().zip(&y.values).zip(&z.values);
            let values = rows.flat_map(|((&x, &y), &z)| [x, y, z]).collect();
            Some((Attribute { name, components: 3, values }, others))
        });
        let (attribute, others) = vector.unwrap_or_else(|| (first.clone(), others));
        attributes.push(attribute);
        rest = others;
    }
    attributes
}

fn vector_name([x, y, z]: [&str; 3]) -> Option<String> {
    match [x.strip_suffix('x')?, y.strip_suffix('y')?, z.strip_suffix('z')?] {
        ["v", "v", "v"] => Some("velocity".to_owned()),
        [a, b, c] if a == b && b == c => a.strip_suffix('_').map(str::to_owned),
        _ => None,
    }
}

/// The properties of a vertex that are read, with the axis of a component.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Field {
    Position(usize),
    Normal(usize),
    Velocity(usize),
    Density,
    Pressure,
    Id,
}

impl Field {
    fn named(name: &str) -> Option<Self> {
        Some(match name {
            "x" => Self::Position(0),
            "y" => Self::Position(1),
            "z" => Self::Position(2),
            "nx" => Self::Normal(0),
            "ny" => Self::Normal(1),
            "nz" => Self::Normal(2),
            "vx" | "u" | "velocity_x" => Self::Velocity(0),
            "vy" | "v" | "velocity_y" => Self::Velocity(1),
            "vz" | "w" | "velocity_z" => Self::Velocity(2),
            "density" | "rho" => Self::Density,
            "pressure" | "p" => Self::Pressure,
            "id" => Self::Id,
            _ => return None,
        })
    }
}
