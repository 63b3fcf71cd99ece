//! NPZ, numpy's archive of named arrays: a reader and a writer for particles.
//!
//! The file is a ZIP archive of NPY files. Arrays are written without compression, so that `numpy.load` is as fast as
//! the disk; compressed arrays (`numpy.savez_compressed`) are read.
//!
//! Arrays written: `positions` and `velocities` (float32, N x 3), `densities` and `pressures` (float32, N), `ids`
//! (uint32, N), where present, and other attributes by their names (float32). Arrays of any number type are read; others
//! are skipped. `time` (float64) and `particle_spacing` (float32) are arrays without axes.

use std::fs::File;
use std::io::{self, BufReader, BufWriter, Read, Write};
use std::path::Path;

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipArchive, ZipWriter};

use crate::atomic;
use crate::data::columns::{Wanted, triples};
use crate::data::info::{PARTICLE_SPACING, TIME};
use crate::data::{Attribute, ParticleInfo, Particles};
use crate::error::IoError;
use crate::input::{MAX_COUNT, regular};
use crate::limit::Budget;
use crate::npy::{self, Layout};

/// Names of the array of positions, in order of preference; the last is numpy's name for an unnamed array.
const POSITIONS: [&str; 7] = ["positions", "position", "points", "particles", "pos", "x", "arr_0"];

/// Bytes of the file of a scalar that are read; numpy writes 136.
const LONGEST_SCALAR: u64 = 4096;

pub(crate) fn write_particles(path: &Path, particles: &Particles) -> Result<u64, IoError> {
    particles.check()?;
    let count = particles.len();
    let fields: [(&str, &str, usize, &[u8]); 5] = [
        ("positions", "<f4", 3, bytemuck::cast_slice(&particles.positions)),
        ("velocities", "<f4", 3, bytemuck::cast_slice(&particles.velocities)),
        ("densities", "<f4", 1, bytemuck::cast_slice(&particles.densities)),
        ("pressures", "<f4", 1, bytemuck::cast_slice(&particles.pressures)),
        ("ids", "<u4", 1, bytemuck::cast_slice(&particles.ids)),
    ];
    let names: Vec<String> = particles.other_attributes().map(file_name).collect();
    let others = particles.other_attributes().zip(&names).map(|(attribute, name)| {
        (name.as_str(), "<f4", attribute.components, bytemuck::cast_slice(&attribute.values))
    });
    let fields = fields.into_iter().filter(|(_, _, _, data)| particles.has(data.len()));
    let arrays: Vec<_> = fields.chain(others).collect();
    // An attribute of the same name would be the same file of the archive.
    let is_free = |name: &str| names.iter().all(|other| other != name);
    let scalars = scalars(particles.info).into_iter().filter(|(name, ..)| is_free(name));
    atomic::write_file(path, |file: &mut BufWriter<File>| {
        let mut archive = ZipWriter::new(file);
        for (name, kind, columns, data) in arrays {
            add(&mut archive, name, &npy::header(kind, &npy::shape(count, columns)), data)?;
        }
        for (name, kind, data) in scalars {
            add(&mut archive, name, &npy::header(kind, "()"), &data)?;
        }
        archive.finish().map(drop).map_err(io::Error::other)
    })
}

/// Adds an array to an archive.
fn add(
    archive: &mut ZipWriter<&mut BufWriter<File>>,
    name: &str,
    header: &[u8],
    data: &[u8],
) -> io::Result<()> {
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Stored)
        .large_file(data.len() as u64 > u64::from(u32::MAX) - 1024);
    archive.start_file(format!("{name}.npy"), options).map_err(io::Error::other)?;
    archive.write_all(header)?;
    archive.write_all(data)
}

/// Name, type and bytes of the known scalars.
fn scalars(info: ParticleInfo) -> Vec<(&'static str, &'static str, Vec<u8>)> {
    let ParticleInfo { time, particle_spacing } = info.credible();
    let time = time.map(|time| (TIME, "<f8", time.to_le_bytes().to_vec()));
    let spacing = particle_spacing.map(|spacing| (PARTICLE_SPACING, "<f4", spacing.to_le_bytes().to_vec()));
    time.into_iter().chain(spacing).collect()
}

/// The name of an attribute without characters that separate folders, because every array is a file of the archive.
fn file_name(attribute: &Attribute) -> String {
    attribute.word().replace(['/', '\\'], "_")
}

pub(crate) fn read(path: &Path, wanted: Wanted) -> Result<Particles, IoError> {
    regular(path)?;
    let file = File::open(path).map_err(|error| IoError::read(path, &error))?;
    let malformed = |reason: String| IoError::malformed(path, "NPZ", reason);
    let mut budget = Budget::of_file(file.metadata().map_or(0, |data| data.len()));
    let mut archive = ZipArchive::new(BufReader::new(file)).map_err(|error| malformed(error.to_string()))?;
    let names: Vec<String> = archive.file_names().filter_map(|name| Some(name.ok()?.into_owned())).collect();
    let stem = |name: &str| name.strip_suffix(".npy").unwrap_or(name).to_ascii_lowercase();
    let find = |wanted: &&str| names.iter().find(|name| stem(name) == *wanted);
    let Some(first) = POSITIONS.iter().find_map(find) else {
        let given = names.iter().map(|name| stem(name)).take(20).collect::<Vec<_>>().join(", ");
        return Err(malformed(format!(
            "none of its arrays ({given:.200}) is named {}",
            POSITIONS.map(|name| format!("`{name}`")).join(", ")
        )));
    };

    let mut particles = Particles::default();
    let positions = array(&mut archive, first, &mut budget).map_err(malformed)?;
    if positions.columns != 3 {
        let columns = positions.columns;
        return Err(malformed(format!(
            "array `{first}` has {columns} numbers per row, but positions have 3"
        )));
    }
    let count = positions.values.len() / 3;
    if count > MAX_COUNT {
        return Err(IoError::TooMany { what: "particles", given: count, limit: MAX_COUNT });
    }
    particles.positions = triples(&positions.values).collect();
    for name in names.iter().filter(|name| *name != first) {
        let own = name.strip_suffix(".npy").unwrap_or(name);
        if ![1, 3].iter().any(|&components| wanted.has(own, components)) {
            continue;
        }
        let Array { columns, values } = match array(&mut archive, name, &mut budget) {
            Ok(array) => array,
            // An array without a field of its own is optional.
            Err(_) if ![1, 3].iter().any(|&n| Wanted::Known.has(own, n)) => continue,
            Err(reason) => return Err(malformed(reason)),
        };
        let rows = values.len() / columns.max(1);
        // Uniform values, and names of one letter, may mean something else.
        if rows != count && rows > 1 && own.len() > 1 && Wanted::Known.has(own, columns) {
            return Err(malformed(format!(
                "array `{name}` has {rows} rows, but there are {count} positions"
            )));
        }
        if !wanted.has(own, columns) || rows != count {
            continue;
        }
        wanted
            .append(&mut particles, own, columns, &values)
            .map_err(|reason| malformed(format!("array `{name}`: {reason}")))?;
    }
    particles.info = info(&mut archive);
    Ok(particles)
}

/// The scalars of an archive; those that cannot be read are ignored.
fn info<R: Read + io::Seek>(archive: &mut ZipArchive<R>) -> ParticleInfo {
    let mut info = ParticleInfo::default();
    for name in [TIME, PARTICLE_SPACING] {
        scalar(archive, name).into_iter().for_each(|value| info.set(name, value));
    }
    info
}

/// An array without axes.
fn scalar<R: Read + io::Seek>(archive: &mut ZipArchive<R>, name: &str) -> Option<f64> {
    let mut bytes = Vec::new();
    archive.by_name(&format!("{name}.npy")).ok()?.take(LONGEST_SCALAR).read_to_end(&mut bytes).ok()?;
    let (header, data) = npy::split(&bytes).ok()?;
    let layout = Layout::of(&header).ok().filter(|layout| layout.shape.is_empty())?;
    layout.number.decode(layout.data(data).ok()?, false).first().copied()
}

/// An array of rows.
struct Array {
    columns: usize,
    values: Vec<f64>,
}

fn array<R: Read + io::Seek>(
    archive: &mut ZipArchive<R>,
    name: &str,
    budget: &mut Budget,
) -> Result<Array, String> {
    let mut read = || -> Result<Array, String> {
        let entry = archive.by_name(name).map_err(|error| error.to_string())?;
        let declared = entry.size();
        budget.take(declared, "it")?;
        // The size in the archive's directory is not reliable, so the data is limited while it is read.
        let mut bytes = Vec::new();
        entry.take(declared.saturating_add(1)).read_to_end(&mut bytes).map_err(|error| error.to_string())?;
        if bytes.len() as u64 > declared {
            return Err(format!("it has more than its {declared} bytes"));
        }
        let (header, data) = npy::split(&bytes)?;
        let layout = Layout::of(&header)?;
        let columns = match layout.shape[..] {
            [_] => 1,
            [_, columns] => columns,
            _ => return Err(format!("its shape is {}, (N,) and (N, K) are read", layout.shape_in_words())),
        };
        Ok(Array { columns, values: layout.number.decode(layout.data(data)?, false) })
    };
    read().map_err(|reason| format!("array `{name}`: {reason}"))
}
