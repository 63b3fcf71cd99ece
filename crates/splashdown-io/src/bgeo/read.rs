//! The reader.

use std::fs::File;
use std::io::{self, BufReader, Read};
use std::path::Path;

use flate2::read::GzDecoder;

use crate::data::columns::{Column, Wanted, triples};
use crate::data::{ParticleInfo, Particles};
use crate::error::IoError;
use crate::input::{MAX_COUNT, regular};
use crate::limit::Budget;
use crate::number::{Cells, Number};

/// The largest size of a row in bytes, far above that of real files. It prevents that a malformed header causes a large
/// allocation.
const MAX_ROW: usize = 1 << 16;

/// The most attributes of the whole that are read; in files with more, all of them are ignored.
const MAX_DETAIL: usize = 64;

/// Rows decoded at a time.
const ROWS: usize = 1024;

pub(crate) fn read(path: &Path, wanted: Wanted) -> Result<Particles, IoError> {
    regular(path)?;
    let failed = |error: io::Error| IoError::read(path, &error);
    let mut file = File::open(path).map_err(failed)?;
    let mut magic = [0; 2];
    let packed = file.read(&mut magic).map_err(failed)? == 2 && magic == [0x1f, 0x8b];
    io::Seek::rewind(&mut file).map_err(failed)?;
    let mut budget = Budget::of_file(file.metadata().map_err(failed)?.len());
    let file = BufReader::new(file);
    let result = match packed {
        true => parse(&mut BufReader::new(GzDecoder::new(file)), wanted, &mut budget),
        false => parse(&mut { file }, wanted, &mut budget),
    };
    result.map_err(|reason| match reason {
        Reason::Text(reason) => IoError::malformed(path, "BGEO", reason),
        Reason::TooMany(given) => IoError::TooMany { what: "particles", given, limit: MAX_COUNT },
    })
}

enum Reason {
    Text(String),
    TooMany(usize),
}

impl From<String> for Reason {
    fn from(text: String) -> Self {
        Self::Text(text)
    }
}

/// An attribute to read: its name, byte in the row, number of components and their type.
struct Place {
    name: String,
    at: usize,
    components: usize,
    number: Number,
}

fn parse(file: &mut impl Read, wanted: Wanted, budget: &mut Budget) -> Result<Particles, Reason> {
    let magic: [u8; 4] = take(file, "its header")?;
    if magic != *b"Bgeo" {
        return Err(Reason::Text("it does not begin with `Bgeo`".to_owned()));
    }
    let [kind]: [u8; 1] = take(file, "its header")?;
    let version = word(file, "its header")?;
    if (kind, version) != (b'V', 5) {
        return Err(Reason::Text(format!("its version is {version}, only the classic version 5 is read")));
    }
    let mut counts = [0; 8];
    for count in &mut counts {
        let given = word(file, "its header")?;
        *count = usize::try_from(given).map_err(|_| format!("its header has a count of {given}"))?;
    }
    let [points, primitives, _, _, attributes, vertex_attributes, primitive_attributes, detail] = counts;
    if points > MAX_COUNT {
        return Err(Reason::TooMany(points));
    }
    // A row begins with x, y, z and a weight.
    let (mut row, mut places) = (16, Vec::new());
    for number in 0..attributes {
        row += attribute(file, number, row, |name, components| wanted.has(name, components), &mut places)?;
        if row > MAX_ROW {
            return Err(Reason::Text(format!("its rows are more than {MAX_ROW} bytes long")));
        }
    }
    budget.take(points as u64 * row as u64, format_args!("its list of {points} points"))?;
    let mut particles = rows(file, points, row, wanted, &places)?;
    if [primitives, vertex_attributes, primitive_attributes] == [0; 3] && detail <= MAX_DETAIL {
        // They are optional, and some programs end the file after the points.
        particles.info = info(file, detail).unwrap_or_default();
    }
    Ok(particles)
}

/// Reads the attributes of the whole, which follow the points in a file without primitives.
fn info(file: &mut impl Read, attributes: usize) -> Result<ParticleInfo, String> {
    let (mut row, mut places) = (0, Vec::new());
    for number in 0..attributes {
        row += attribute(file, number, row, |name, _| ParticleInfo::has(name), &mut places)?;
    }
    let mut bytes = vec![0; row];
    file.read_exact(&mut bytes).map_err(|error| error.to_string())?;
    let mut info = ParticleInfo::default();
    for Place { name, at, components, number } in places.iter().filter(|place| place.components == 1) {
        let mut values = Vec::<f64>::new();
        let cells = Cells { at: *at, components: *components, stride: row, big_endian: true };
        number.decode_cells(&bytes, cells, &mut values);
        values.first().iter().for_each(|&&value| info.set(name, value));
    }
    Ok(info)
}

/// Reads the description of the attribute at byte `at` of a row; returns its size in the row, in bytes.
fn attribute(
    file: &mut impl Read,
    number: usize,
    at: usize,
    wanted: impl Fn(&str, usize) -> bool,
    places: &mut Vec<Place>,
) -> Result<usize, String> {
    let what = "its list of attributes";
    let name = text(file, what)?;
    let components = usize::from(u16::from_be_bytes(take(file, what)?));
    let kind = match word(file, what)? {
        0 | 5 => Some(Number::F32),
        1 => Some(Number::I32),
        // Indices of strings, which follow instead of default values.
        4 => None,
        kind => {
            return Err(format!(
                "attribute {number} (`{name:.24}`) is of type {kind}, but only types 0, 1, 4 and 5 are read"
            ));
        }
    };
    if let Some(kind) = kind {
        for _ in 0..components {
            word(file, what)?;
        }
        if wanted(&name, components) {
            let is_id = Column::named(&name, components) == Some(Column::Id);
            // The format has only signed integers; larger ids are stored in their bits.
            let number = if is_id && kind == Number::I32 { Number::U32 } else { kind };
            places.push(Place { name, at, components, number });
        }
    } else {
        for _ in 0..word(file, what)? {
            text(file, what)?;
        }
    }
    Ok(4 * components)
}

fn rows(
    file: &mut impl Read,
    points: usize,
    row: usize,
    wanted: Wanted,
    places: &[Place],
) -> Result<Particles, Reason> {
    let mut particles = Particles::default();
    let mut buffer = vec![0; ROWS * row];
    for first in (0..points).step_by(ROWS) {
        let bytes = &mut buffer[..row * ROWS.min(points - first)];
        file.read_exact(bytes).map_err(|error| {
            cut(
                &error,
                &format!("its header declares {points} points, but the data ends after about {first}"),
            )
        })?;
        let numbers = |number: Number, at, components| {
            let mut values = Vec::<f64>::new();
            number.decode_cells(bytes, Cells { at, components, stride: row, big_endian: true }, &mut values);
            values
        };
        particles.positions.extend(triples(&numbers(Number::F32, 0, 3)));
        for &Place { ref name, at, components, number } in places {
            wanted.append(&mut particles, name, components, &numbers(number, at, components))?;
        }
    }
    Ok(particles)
}

fn take<const N: usize>(file: &mut impl Read, what: &str) -> Result<[u8; N], String> {
    let mut bytes = [0; N];
    file.read_exact(&mut bytes).map_err(|error| cut(&error, &format!("it ends inside {what}")))?;
    Ok(bytes)
}

fn word(file: &mut impl Read, what: &str) -> Result<i32, String> {
    take(file, what).map(i32::from_be_bytes)
}

fn text(file: &mut impl Read, what: &str) -> Result<String, String> {
    let mut bytes = vec![0; usize::from(u16::from_be_bytes(take(file, what)?))];
    file.read_exact(&mut bytes).map_err(|error| cut(&error, &format!("it ends inside {what}")))?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// A message for a premature end, or of the gzip decoder.
fn cut(error: &io::Error, place: &str) -> String {
    match error.kind() {
        io::ErrorKind::UnexpectedEof => format!("it was cut short: {place}"),
        _ => format!("{place}: {error}"),
    }
}
