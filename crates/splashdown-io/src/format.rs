//! The table of file formats. Reading and writing by file name, messages and help texts derive from it.

use std::io::{self, Write};
use std::path::Path;

use crate::data::Mesh;
use crate::data::Particles;
use crate::data::columns::Wanted;
use crate::error::IoError;
use crate::{atomic, bgeo, gltf, npy, npz, obj, ply, stl, vtk, vtu, xyz};

type ReadParticles = fn(&Path, Wanted) -> Result<Particles, IoError>;
type WriteParticles = fn(&Path, &Particles) -> Result<u64, IoError>;
type ReadMesh = fn(&Path) -> Result<Mesh, IoError>;
type WriteMesh = fn(&Path, &Mesh) -> Result<u64, IoError>;

/// The data in files with one ending, and whether they are read or written.
#[derive(Debug, Clone, Copy)]
pub struct Format {
    /// Name of the format as messages use it, e.g. `PLY`.
    pub name: &'static str,
    /// Ending of the file names, with its dot.
    pub ending: &'static str,
    pub(crate) read_particles: Option<ReadParticles>,
    pub(crate) write_particles: Option<WriteParticles>,
    pub(crate) read_mesh: Option<ReadMesh>,
    pub(crate) write_mesh: Option<WriteMesh>,
    is_series: bool,
    has_velocities: bool,
    has_attributes: bool,
    has_index: bool,
}

/// A format that is neither read nor written.
const NONE: Format = Format {
    name: "",
    ending: "",
    read_particles: None,
    write_particles: None,
    read_mesh: None,
    write_mesh: None,
    is_series: false,
    has_velocities: false,
    has_attributes: false,
    has_index: false,
};

impl Format {
    /// All formats, a row for each ending.
    pub const ALL: &'static [Self] = &[
        Self {
            name: "PLY",
            ending: ".ply",
            read_particles: Some(ply::read),
            write_particles: Some(|path, particles| {
                write_particles(path, particles, ply::write_particles_to)
            }),
            read_mesh: Some(ply::read_mesh),
            write_mesh: Some(|path, mesh| write_mesh(path, mesh, ply::write_mesh_to)),
            has_velocities: true,
            has_attributes: true,
            ..NONE
        },
        Self {
            name: "VTK",
            ending: ".vtk",
            read_particles: Some(vtk::read),
            write_particles: Some(|path, particles| {
                write_particles(path, particles, vtk::write_particles_to)
            }),
            read_mesh: Some(vtk::read_mesh),
            write_mesh: Some(|path, mesh| write_mesh(path, mesh, vtk::write_mesh_to)),
            has_velocities: true,
            has_attributes: true,
            ..NONE
        },
        Self {
            name: "VTU",
            ending: ".vtu",
            read_particles: Some(vtu::read),
            write_particles: Some(|path, particles| {
                write_particles(path, particles, vtu::write_particles_to)
            }),
            has_index: true,
            ..NONE
        },
        Self {
            name: "VTP",
            ending: ".vtp",
            read_particles: Some(vtu::read),
            write_particles: Some(|path, particles| {
                write_particles(path, particles, vtu::write_poly_particles_to)
            }),
            read_mesh: Some(vtu::read_mesh),
            write_mesh: Some(|path, mesh| write_mesh(path, mesh, vtu::write_mesh_to)),
            has_velocities: true,
            has_attributes: true,
            has_index: true,
            ..NONE
        },
        Self {
            name: "BGEO",
            ending: ".bgeo",
            read_particles: Some(bgeo::read),
            write_particles: Some(|path, particles| {
                write_particles(path, particles, bgeo::write_particles_to)
            }),
            ..NONE
        },
        Self {
            name: "NPZ",
            ending: ".npz",
            read_particles: Some(npz::read),
            write_particles: Some(npz::write_particles),
            ..NONE
        },
        Self { name: "NPY", ending: ".npy", read_particles: Some(npy::read), ..NONE },
        Self { name: "XYZ", ending: ".xyz", read_particles: Some(xyz::read), ..NONE },
        Self {
            name: "OBJ",
            ending: ".obj",
            read_mesh: Some(obj::read_mesh),
            write_mesh: Some(|path, mesh| write_mesh(path, mesh, obj::write_mesh_to)),
            ..NONE
        },
        Self {
            name: "STL",
            ending: ".stl",
            read_mesh: Some(stl::read_mesh),
            write_mesh: Some(|path, mesh| write_mesh(path, mesh, stl::write_mesh_to)),
            ..NONE
        },
        Self {
            name: "glTF",
            ending: ".glb",
            read_mesh: Some(gltf::read_mesh),
            write_mesh: Some(gltf::write_mesh),
            has_velocities: true,
            ..NONE
        },
        Self { name: "glTF", ending: ".gltf", read_mesh: Some(gltf::read_mesh), ..NONE },
        // Written by `StageFile`.
        Self { name: "USD", ending: ".usdc", is_series: true, has_velocities: true, ..NONE },
    ];

    /// The format of a file by the ending of its name, in any case; `.bgeo.gz` is BGEO.
    #[must_use]
    pub fn of(path: &Path) -> Option<&'static Self> {
        let ending = match extension(path)? {
            // Of two endings the first one names the format of the content.
            gz if gz == "gz" => extension(&path.with_extension("")).filter(|inner| inner == "bgeo")?,
            ending => ending,
        };
        Self::with_ending(&ending)
    }

    /// The format with an ending, given in lower case and without its dot.
    #[must_use]
    pub fn with_ending(ending: &str) -> Option<&'static Self> {
        Self::ALL.iter().find(|format| format.ending.strip_prefix('.') == Some(ending))
    }

    /// The endings of all formats that meet a condition, e.g. `Format::endings(Format::reads_meshes)`.
    pub fn endings(condition: impl Fn(&Self) -> bool) -> Vec<&'static str> {
        Self::ALL.iter().filter(|format| condition(format)).map(|format| format.ending).collect()
    }

    /// Whether [`read_particles`](crate::read_particles) reads it.
    #[must_use]
    pub fn reads_particles(&self) -> bool {
        self.read_particles.is_some()
    }

    /// Whether [`write_particles`](crate::write_particles) writes it, or [`StageFile`](crate::StageFile).
    #[must_use]
    pub fn writes_particles(&self) -> bool {
        self.write_particles.is_some() || self.is_series
    }

    /// Whether [`read_mesh`](crate::read_mesh) reads it.
    #[must_use]
    pub fn reads_meshes(&self) -> bool {
        self.read_mesh.is_some()
    }

    /// Whether [`write_mesh`](crate::write_mesh) writes it, or [`StageFile`](crate::StageFile).
    #[must_use]
    pub fn writes_meshes(&self) -> bool {
        self.write_mesh.is_some() || self.is_series
    }

    /// Whether one file contains all frames of a run. Files of other formats contain one frame.
    #[must_use]
    pub fn is_series(&self) -> bool {
        self.is_series
    }

    /// Whether a mesh file contains the [`velocities`](Mesh::velocities).
    #[must_use]
    pub fn has_velocities(&self) -> bool {
        self.has_velocities
    }

    /// Whether a mesh file contains the [`attributes`](Mesh::attributes).
    #[must_use]
    pub fn has_attributes(&self) -> bool {
        self.has_attributes
    }

    /// Whether the index of a series ([`pvd`](crate::pvd)) can list its files.
    #[must_use]
    pub fn has_index(&self) -> bool {
        self.has_index
    }
}

fn write_particles(
    path: &Path,
    particles: &Particles,
    fill: fn(&mut dyn Write, &Particles) -> io::Result<()>,
) -> Result<u64, IoError> {
    particles.check()?;
    atomic::write(path, |out| fill(out, particles))
}

fn write_mesh(
    path: &Path,
    mesh: &Mesh,
    fill: fn(&mut dyn Write, &Mesh) -> io::Result<()>,
) -> Result<u64, IoError> {
    mesh.check()?;
    atomic::write(path, |out| fill(out, mesh))
}

/// The ending of a file name in lower case, without its dot.
fn extension(path: &Path) -> Option<String> {
    Some(path.extension()?.to_str()?.to_ascii_lowercase())
}

/// The error for a path whose ending names no format that fulfils the condition.
pub(crate) fn unknown(path: &Path, condition: fn(&Format) -> bool) -> IoError {
    IoError::UnknownFormat { path: path.to_owned(), allowed: Format::endings(condition) }
}

#[cfg(test)]
mod tests {
    use super::Format;
    use std::collections::HashSet;
    use std::path::Path;

    #[test]
    fn endings_are_distinct_and_each_format_is_read_or_written() {
        let endings: HashSet<&str> = Format::ALL.iter().map(|format| format.ending).collect();
        assert_eq!(endings.len(), Format::ALL.len());
        for format in Format::ALL {
            assert!(format.ending.starts_with('.') && format.ending == format.ending.to_ascii_lowercase());
            assert!(
                format.reads_particles()
                    || format.reads_meshes()
                    || format.writes_particles()
                    || format.writes_meshes()
            );
            let name = format!("folder.obj/name{}", format.ending.to_ascii_uppercase());
            assert_eq!(Format::of(Path::new(&name)).map(|found| found.ending), Some(format.ending));
        }
    }

    #[test]
    fn the_first_ending_of_a_compressed_file_selects_the_format() {
        let found = |name: &str| Format::of(Path::new(name)).map(|format| format.name);
        assert_eq!(found("a.BGEO.gz"), Some("BGEO"));
        assert_eq!(["a.ply.gz", "bgeo.gz", "a.gz", "ply", "a", "a.", "a.fbx"].map(found), [None; 7]);
    }
}
