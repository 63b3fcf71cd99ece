//! The readers: any encoding, any numeric type, properties in any order; unknown ones are skipped.

use std::fs::File;
use std::io::{BufReader, Read};
use std::path::Path;

use ply_rs_bw::parser::{Parser, Reader};
use ply_rs_bw::ply::{
    ElementDef, Encoding, Header, Property, PropertyAccess, PropertyAccessResult, PropertyDef, PropertyType,
    ScalarType,
};

use crate::data::Attribute;
use crate::data::Mesh;
use crate::data::Particles;
use crate::data::columns::{Wanted, whole};
use crate::error::IoError;
use crate::input::not_particles;

/// Reads particles from the `vertex` element of a PLY file.
///
/// `x y z` must be there; `vx vy vz` (or `velocity_x ..`, `u v w`), `density` (`rho`), `pressure` (`p`) and `id` are
/// taken where they are present. Other elements are ignored, but for faces: the vertices of a mesh are not particles.
///
/// # Errors
/// [`IoError::Read`] or [`IoError::Malformed`], which says what is missing or where the file ends too early.
pub fn read_particles(path: &Path) -> Result<Particles, IoError> {
    read(path, Wanted::Known)
}

pub(crate) fn read(path: &Path, wanted: Wanted) -> Result<Particles, IoError> {
    let file = PlyFile::open(path)?;
    let element = file.element("vertex")?;
    let has = Present::of(element);
    let names: Vec<String> = Everything::names(element).map(str::to_owned).collect();
    if let Some(faces) = file.header.elements.get("face").filter(|face| face.count > 0) {
        return Err(malformed(path, not_particles(faces.count)));
    }
    if wanted == Wanted::Known {
        return Ok(known(&file.read::<Vertex>(false)?.0, &has));
    }
    let (vertices, _) = file.read::<Everything>(false)?;
    let columns = names.iter().enumerate().map(|(column, name)| {
        let values = vertices.iter().map(|vertex| vertex.others[column]).collect();
        Attribute { name: name.clone(), components: 1, values }
    });
    let attributes = vectors(columns.collect());
    let vertices: Vec<Vertex> = vertices.into_iter().map(|vertex| vertex.known).collect();
    Ok(Particles { attributes, ..known(&vertices, &has) })
}

fn known(vertices: &[Vertex], has: &Present) -> Particles {
    let every = |present: bool| vertices.iter().take(if present { usize::MAX } else { 0 });
    Particles {
        ids: every(has.id).map(|v| v.id).collect(),
        positions: vertices.iter().map(|v| v.position).collect(),
        velocities: every(has.velocity == [true; 3]).map(|v| v.velocity).collect(),
        densities: every(has.density).map(|v| v.density).collect(),
        pressures: every(has.pressure).map(|v| v.pressure).collect(),
        attributes: Vec::new(),
    }
}

/// Puts three numbers that follow one another and are called `a_x a_y a_z`, or `vx vy vz`, together.
fn vectors(mut columns: Vec<Attribute>) -> Vec<Attribute> {
    let mut found = Vec::new();
    while !columns.is_empty() {
        let stem = |column: usize, axis: char| columns.get(column)?.name.strip_suffix(axis);
        let stems = [stem(0, 'x'), stem(1, 'y'), stem(2, 'z')];
        let name = match stems {
            [Some("v"), Some("v"), Some("v")] => Some("velocity".to_owned()),
            [Some(a), Some(b), Some(c)] if a == b && b == c => a.strip_suffix('_').map(str::to_owned),
            _ => None,
        };
        match name {
            Some(name) => {
                let three: Vec<Attribute> = columns.drain(..3).collect();
                let rows = 0..three[0].values.len();
                let values = rows.flat_map(|row| three.iter().map(move |column| column.values[row]));
                found.push(Attribute { name, components: 3, values: values.collect() });
            }
            None => found.push(columns.remove(0)),
        }
    }
    found
}

/// Reads a mesh from the `vertex` and `face` elements of a PLY file.
///
/// Normals are taken where `nx ny nz` are present, velocities where `vx vy vz` are. Polygons are cut into fans
/// of triangles.
///
/// # Errors
/// [`IoError::Read`] or [`IoError::Malformed`]; also a face with fewer than three corners or one that names a vertex
/// that does not exist.
pub fn read_mesh(path: &Path) -> Result<Mesh, IoError> {
    let file = PlyFile::open(path)?;
    file.element("face")?;
    let has = Present::of(file.element("vertex")?);
    let (vertices, faces) = file.read::<Vertex>(true)?;
    let mut mesh = Mesh { vertices: vertices.iter().map(|v| v.position).collect(), ..Mesh::default() };
    if has.normal == [true; 3] {
        mesh.normals = vertices.iter().map(|v| v.normal).collect();
    }
    if has.velocity == [true; 3] {
        mesh.velocities = vertices.iter().map(|v| v.velocity).collect();
    }
    for (number, face) in faces.iter().enumerate() {
        let [first, rest @ ..] = face.corners.as_slice() else {
            return Err(malformed(path, format!("face {number} has no corners (property `vertex_indices`)")));
        };
        if rest.len() < 2 {
            return Err(malformed(
                path,
                format!("face {number} has {} corners, at least 3 are needed", rest.len() + 1),
            ));
        }
        mesh.triangles.extend(rest.windows(2).map(|pair| [*first, pair[0], pair[1]]));
    }
    mesh.check().map_err(|error| malformed(path, error.to_string()))?;
    Ok(mesh)
}

fn malformed(path: &Path, reason: impl Into<String>) -> IoError {
    IoError::malformed(path, "PLY", reason)
}

/// A PLY file whose header has been read and found possible.
struct PlyFile<'a> {
    path: &'a Path,
    reader: Reader<BufReader<File>>,
    header: Header,
}

impl<'a> PlyFile<'a> {
    fn open(path: &'a Path) -> Result<Self, IoError> {
        let failed = |error| IoError::read(path, &error);
        let mut file = File::open(path).map_err(failed)?;
        let size = file.metadata().map_err(failed)?.len();
        let mut magic = [0; 3];
        let start = file.read(&mut magic).map_err(failed)?;
        if magic[..start] != *b"ply" {
            return Err(malformed(path, "it does not begin with the line `ply`"));
        }
        // The first line goes to the parser again, which wants the whole file.
        std::io::Seek::rewind(&mut file).map_err(failed)?;
        let mut reader = Reader::new(BufReader::new(file));
        let header =
            Parser::<Vertex>::new().read_header(&mut reader).map_err(|e| malformed(path, one_line(&e)))?;
        for (_, element) in &header.elements {
            fits(element, header.encoding, size).map_err(|reason| malformed(path, reason))?;
        }
        Ok(Self { path, reader, header })
    }

    fn element(&self, name: &str) -> Result<&ElementDef, IoError> {
        let known = || self.header.elements.keys().map(String::as_str).collect::<Vec<_>>().join(", ");
        let found = self.header.elements.get(name);
        // The points of a scan or of a particle file are what is mistaken for a mesh most often.
        let points = match self.header.elements.get("vertex") {
            Some(vertex) if name == "face" => format!(" ({} points): points are no mesh", vertex.count),
            _ => String::new(),
        };
        let element = found.ok_or_else(|| {
            malformed(self.path, format!("it has no element `{name}`, only: {}{points}", known()))
        })?;
        for axis in if name == "vertex" { ["x", "y", "z"].as_slice() } else { &[] } {
            if !element.properties.contains_key(*axis) {
                return Err(malformed(self.path, format!("its vertices have no property `{axis}`")));
            }
        }
        Ok(element)
    }

    /// Reads the vertices and, if wanted, the faces. Elements stand in the file in the header's order.
    fn read<V: PropertyAccess>(mut self, want_faces: bool) -> Result<(Vec<V>, Vec<Face>), IoError> {
        let (mut vertices, mut faces) = (None, None);
        for (name, element) in &self.header.elements {
            let done = vertices.is_some() && (faces.is_some() || !want_faces);
            if done {
                break;
            }
            let (reader, header) = (&mut self.reader, &self.header);
            let read = match name.as_str() {
                "vertex" => Parser::new()
                    .read_payload_for_element(reader, element, header)
                    .map(|v| vertices = Some(v)),
                "face" => {
                    Parser::new().read_payload_for_element(reader, element, header).map(|f| faces = Some(f))
                }
                _ => Parser::<Skipped>::new().read_payload_for_element(reader, element, header).map(drop),
            };
            read.map_err(|e| malformed(self.path, format!("in element `{name}`: {}", one_line(&e))))?;
        }
        Ok((vertices.unwrap_or_default(), faces.unwrap_or_default()))
    }
}

/// The parser's messages hold line breaks and tabs; an error here is one line.
fn one_line(error: &dyn std::error::Error) -> String {
    error.to_string().split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Refuses an element that cannot fit into the file even if all its lists are empty, before memory is asked for it.
fn fits(element: &ElementDef, encoding: Encoding, file_size: u64) -> Result<(), String> {
    let smallest = |kind: &ScalarType| match (encoding, kind) {
        (Encoding::Ascii, _) => 2, // a digit and a space
        (_, ScalarType::Char | ScalarType::UChar) => 1,
        (_, ScalarType::Short | ScalarType::UShort) => 2,
        (_, ScalarType::Int | ScalarType::UInt | ScalarType::Float) => 4,
        (_, ScalarType::Double) => 8,
    };
    let row: u64 = element
        .properties
        .values()
        .map(|property| match &property.data_type {
            PropertyType::Scalar(kind) | PropertyType::List(kind, _) => smallest(kind),
        })
        .sum();
    let (name, count) = (&element.name, element.count as u64);
    if count > 0 && row == 0 {
        return Err(format!("its header promises {count} `{name}` without any property"));
    }
    // The last line of a text file may lack its line break.
    if count.saturating_mul(row) > file_size + 1 {
        return Err(format!(
            "its header promises {count} `{name}`, which need at least {} bytes, but the file has {file_size}: it was cut short",
            count.saturating_mul(row)
        ));
    }
    Ok(())
}

/// Which attributes the `vertex` element has. A vector is used only with all its components.
struct Present {
    normal: [bool; 3],
    velocity: [bool; 3],
    density: bool,
    pressure: bool,
    id: bool,
}

impl Present {
    fn of(element: &ElementDef) -> Self {
        let mut present =
            Self { normal: [false; 3], velocity: [false; 3], density: false, pressure: false, id: false };
        for field in element.properties.keys().filter_map(|name| Field::named(name)) {
            match field {
                Field::Position(_) => {}
                Field::Normal(axis) => present.normal[axis] = true,
                Field::Velocity(axis) => present.velocity[axis] = true,
                Field::Density => present.density = true,
                Field::Pressure => present.pressure = true,
                Field::Id => present.id = true,
            }
        }
        present
    }
}

/// The properties that mean something here.
#[derive(Clone, Copy)]
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

/// One row of the `vertex` element.
#[derive(Default)]
struct Vertex {
    position: [f32; 3],
    normal: [f32; 3],
    velocity: [f32; 3],
    density: f32,
    pressure: f32,
    id: u32,
}

impl PropertyAccess for Vertex {
    fn new() -> Self {
        Self::default()
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        let Some(field) = Field::named(name) else { return PropertyAccessResult::Ignored };
        let target = match field {
            Field::Position(axis) => &mut self.position[axis],
            Field::Normal(axis) => &mut self.normal[axis],
            Field::Velocity(axis) => &mut self.velocity[axis],
            Field::Density => &mut self.density,
            Field::Pressure => &mut self.pressure,
            Field::Id => return self.set_id(&property),
        };
        match property.to_f32_lossy() {
            Some(value) => *target = value,
            None => return PropertyAccessResult::UnsupportedType,
        }
        PropertyAccessResult::Set
    }
}

/// One row of the `vertex` element with all its numbers.
struct Everything {
    known: Vertex,
    others: Vec<f32>,
}

impl Everything {
    /// The numbers in the order of the file, but for the position.
    fn names(element: &ElementDef) -> impl Iterator<Item = &str> {
        let is_number = |property: &PropertyDef| matches!(property.data_type, PropertyType::Scalar(_));
        let numbers = element.properties.iter().filter(move |(_, property)| is_number(property));
        numbers.map(|(name, _)| name.as_str()).filter(|name| !Self::is_position(name))
    }

    fn is_position(name: &str) -> bool {
        matches!(Field::named(name), Some(Field::Position(_)))
    }
}

impl PropertyAccess for Everything {
    fn new() -> Self {
        Self { known: Vertex::default(), others: Vec::new() }
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        let value = property.to_f32_lossy();
        let known = self.known.set_property(name, property);
        match value {
            Some(value) if !Self::is_position(name) => self.others.push(value),
            _ => return known,
        }
        match known {
            PropertyAccessResult::Ignored => PropertyAccessResult::Set,
            known => known,
        }
    }
}

impl Vertex {
    /// Ids go through integers, because f32 is exact only up to 2^24.
    fn set_id(&mut self, property: &Property) -> PropertyAccessResult {
        let id = match *property {
            Property::Char(v) => u32::try_from(v).ok(),
            Property::UChar(v) => Some(v.into()),
            Property::Short(v) => u32::try_from(v).ok(),
            Property::UShort(v) => Some(v.into()),
            Property::Int(v) => u32::try_from(v).ok(),
            Property::UInt(v) => Some(v),
            Property::Float(v) => whole(v.into()),
            Property::Double(v) => whole(v),
            _ => None,
        };
        match id {
            Some(id) => self.id = id,
            None => return PropertyAccessResult::UnsupportedType,
        }
        PropertyAccessResult::Set
    }
}

/// One row of the `face` element.
#[derive(Default)]
struct Face {
    corners: Vec<u32>,
}

impl PropertyAccess for Face {
    fn new() -> Self {
        Self::default()
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        if !matches!(name, "vertex_indices" | "vertex_index") {
            return PropertyAccessResult::Ignored;
        }
        match property.to_u32_list() {
            Some(corners) => self.corners = corners,
            None => return PropertyAccessResult::UnsupportedType,
        }
        PropertyAccessResult::Set
    }
}

/// A row of an element that is of no use here.
struct Skipped;

impl PropertyAccess for Skipped {
    fn new() -> Self {
        Self
    }
}
