//! Legacy VTK files (`.vtk`), which every program of the VTK family opens: readers and writers for particles and meshes.
//!
//! The readers accept text and binary files of the kinds `POLYDATA` and `UNSTRUCTURED_GRID`. That of particles reads points
//! and their arrays, that of meshes points and polygons; other data is skipped.
//!
//! *Why own code:* `vtkio` 0.6 depends on a parser of 2017 (`nom` 3), has had no release since March 2025 and reads
//! files into its own model of every kind of grid, of which only points and their arrays are needed. Format: VTK User's
//! Guide, "Simple Legacy Formats", and the additions of VTK 9 (`METADATA`, cells as `OFFSETS` and `CONNECTIVITY`).

mod cursor;
mod mesh;
mod read;
mod write;

pub(crate) use mesh::read_mesh;
pub(crate) use read::read;
pub use write::{write_mesh_to, write_particles_to};
