//! Reading and writing particles and meshes.

use std::path::PathBuf;
use std::sync::Arc;

use pyo3::prelude::*;
use splashdown_io::{Format, IoError};

use crate::errors::Result;
use crate::mesh::Mesh;
use crate::particles::Particles;

/// Reads particles with all attributes of the file; there may be none. `particle_formats()[0]` lists the endings.
///
/// >>> size = splashdown.write_particles(folder / "points.ply", splashdown.Particles(numpy.ones((4, 3), numpy.float32)))
/// >>> len(splashdown.read_particles(folder / "points.ply"))
/// 4
#[pyfunction]
pub fn read_particles(py: Python<'_>, path: PathBuf) -> Result<Particles> {
    match py.detach(|| splashdown_io::read_particles_with_attributes(&path)) {
        // A file of foam before the first splash has none.
        Err(IoError::NoParticles { .. }) => Ok(Particles(Arc::default())),
        read => Ok(Particles(Arc::new(read?))),
    }
}

/// Writes particles in the format of the ending, and returns the size of the file in bytes. The file is complete or absent.
///
/// >>> splashdown.write_particles(folder / "points.vtu", splashdown.Particles(numpy.ones((4, 3), numpy.float32))) > 48
/// True
#[pyfunction]
pub fn write_particles(py: Python<'_>, path: PathBuf, particles: &Bound<'_, Particles>) -> Result<u64> {
    let particles = &particles.get().0;
    Ok(py.detach(|| splashdown_io::write_particles(&path, particles))?)
}

/// Reads a mesh. `mesh_formats()[0]` lists the endings.
///
/// >>> size = splashdown.write_mesh(folder / "drop.obj", simulation.surface())
/// >>> splashdown.read_mesh(folder / "drop.obj").is_watertight
/// True
#[pyfunction]
pub fn read_mesh(py: Python<'_>, path: PathBuf) -> Result<Mesh> {
    Ok(Mesh(Arc::new(py.detach(|| splashdown_io::read_mesh(&path))?)))
}

/// Writes a mesh in the format of the ending, and returns the size of the file in bytes. The file is complete or absent.
///
/// >>> splashdown.write_mesh(folder / "drop.glb", simulation.surface()) > 100
/// True
#[pyfunction]
pub fn write_mesh(py: Python<'_>, path: PathBuf, mesh: &Bound<'_, Mesh>) -> Result<u64> {
    let mesh = &mesh.get().0;
    Ok(py.detach(|| splashdown_io::write_mesh(&path, mesh))?)
}

/// The endings of particle files that can be read, and of those that can be written.
///
/// >>> read, written = splashdown.particle_formats()
/// >>> ".ply" in read and ".bgeo" in written
/// True
#[pyfunction]
pub fn particle_formats() -> (Vec<&'static str>, Vec<&'static str>) {
    (
        Format::endings(Format::reads_particles),
        Format::endings(|format| format.writes_particles() && !format.is_series()),
    )
}

/// The endings of mesh files that can be read, and of those that can be written.
///
/// >>> read, written = splashdown.mesh_formats()
/// >>> ".stl" in read and ".glb" in written
/// True
#[pyfunction]
pub fn mesh_formats() -> (Vec<&'static str>, Vec<&'static str>) {
    (
        Format::endings(Format::reads_meshes),
        Format::endings(|format| format.writes_meshes() && !format.is_series()),
    )
}
