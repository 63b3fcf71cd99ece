//! NPZ, numpy's archive of named arrays: a reader and a writer for particles.
//!
//! A zip archive of NPY files. The archive is the crate `zip`'s; arrays are stored unpacked, so that `numpy.load` is as
//! fast as the disk, and packed ones (`numpy.savez_compressed`) are read too.

use std::fs::File;
use std::io::{self, BufReader, BufWriter, Read, Write};
use std::path::Path;

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipArchive, ZipWriter};

use crate::atomic;
use crate::data::Particles;
use crate::data::columns::{Wanted, triples};
use crate::error::IoError;
use crate::input::{MOST, regular};
use crate::npy::{self, Layout};

/// Names under which positions are found, the first one that is there; the last is numpy's own for an array
/// without one.
const POSITIONS: [&str; 7] = ["positions", "position", "points", "particles", "pos", "x", "arr_0"];

/// Writes particles to `path`, complete or not at all; returns the file's size in bytes.
///
/// The arrays are `positions` (float32, N x 3) and, where they are present, `velocities` (float32, N x 3), `densities`,
/// `pressures` (float32, N) and `ids` (uint32, N).
///
/// # Errors
/// Those of [`Particles::check`]; [`IoError::Write`].
pub fn write_particles(path: &Path, particles: &Particles) -> Result<u64, IoError> {
    particles.check()?;
    let count = particles.len();
    let arrays: [(&str, &str, usize, &[u8]); 5] = [
        ("positions", "<f4", 3, bytemuck::cast_slice(&particles.positions)),
        ("velocities", "<f4", 3, bytemuck::cast_slice(&particles.velocities)),
        ("densities", "<f4", 1, bytemuck::cast_slice(&particles.densities)),
        ("pressures", "<f4", 1, bytemuck::cast_slice(&particles.pressures)),
        ("ids", "<u4", 1, bytemuck::cast_slice(&particles.ids)),
    ];
    atomic::write_file(path, |file: &mut BufWriter<File>| {
        let mut archive = ZipWriter::new(file);
        for (name, kind, columns, data) in arrays {
            if data.is_empty() && name != "positions" {
                continue;
            }
            let options = SimpleFileOptions::default()
                .compression_method(CompressionMethod::Stored)
                .large_file(data.len() as u64 > u64::from(u32::MAX) - 1024);
            archive.start_file(format!("{name}.npy"), options).map_err(io::Error::other)?;
            archive.write_all(&npy::header(kind, [count, columns]))?;
            archive.write_all(data)?;
        }
        archive.finish().map(drop).map_err(io::Error::other)
    })
}

/// Reads particles: the first array that is named `positions`, `position`, `points`, `particles`, `pos`, `x` or
/// `arr_0`, and where they are there `velocities` (`velocity`, `v`), `densities`, `pressures` and `ids`, of any
/// type of numbers. Other arrays are passed over.
///
/// # Errors
/// [`IoError::Read`]; [`IoError::Malformed`], which names the array; [`IoError::TooMany`].
pub fn read_particles(path: &Path) -> Result<Particles, IoError> {
    read(path, Wanted::Known)
}

pub(crate) fn read(path: &Path, wanted: Wanted) -> Result<Particles, IoError> {
    regular(path)?;
    let file = File::open(path).map_err(|error| IoError::read(path, &error))?;
    let malformed = |reason: String| IoError::malformed(path, "NPZ", reason);
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
    let positions = array(&mut archive, first).map_err(malformed)?;
    if positions.columns != 3 {
        let columns = positions.columns;
        return Err(malformed(format!("array `{first}` has {columns} numbers in a row, positions have 3")));
    }
    let count = positions.values.len() / 3;
    if count > MOST {
        return Err(IoError::TooMany { what: "particles", given: count, limit: MOST });
    }
    particles.positions = triples(&positions.values).collect();
    for name in names.iter().filter(|name| *name != first) {
        let own = name.strip_suffix(".npy").unwrap_or(name);
        if ![1, 3].iter().any(|&components| wanted.has(own, components)) {
            continue;
        }
        let Array { columns, values } = match array(&mut archive, name) {
            Ok(array) => array,
            // Of an array that means nothing here no more is asked than that it can be used.
            Err(_) if ![1, 3].iter().any(|&n| Wanted::Known.has(own, n)) => continue,
            Err(reason) => return Err(malformed(reason)),
        };
        if !wanted.has(own, columns) || values.len() / columns.max(1) != count {
            continue;
        }
        wanted
            .append(&mut particles, own, columns, &values)
            .map_err(|reason| malformed(format!("array `{name}`: {reason}")))?;
    }
    Ok(particles)
}

/// Numbers in rows.
struct Array {
    columns: usize,
    values: Vec<f64>,
}

fn array<R: Read + io::Seek>(archive: &mut ZipArchive<R>, name: &str) -> Result<Array, String> {
    let mut read = || -> Result<Array, String> {
        let entry = archive.by_name(name).map_err(|error| error.to_string())?;
        // What the archive says of an array's size is not to be trusted; what it holds is.
        let most = 24 * MOST as u64 + (1 << 16);
        let mut bytes = Vec::new();
        entry.take(most).read_to_end(&mut bytes).map_err(|error| error.to_string())?;
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
