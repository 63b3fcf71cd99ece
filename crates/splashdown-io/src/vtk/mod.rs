//! Legacy VTK files (`.vtk`), which every program of the VTK family opens: a reader for particles and writers for
//! particles and meshes.
//!
//! The reader accepts text and binary files of the kinds `POLYDATA` and `UNSTRUCTURED_GRID`. It reads points and their
//! arrays; cells and other data are skipped.
//!
//! *Why own code:* `vtkio` 0.6 depends on a parser of 2017 (`nom` 3), has had no release since March 2025 and reads
//! files into its own model of every kind of grid, of which only points and their arrays are needed. Format: VTK User's
//! Guide, "Simple Legacy Formats", and the additions of VTK 9 (`METADATA`, cells as `OFFSETS` and `CONNECTIVITY`).

mod read;
mod write;

pub(crate) use read::read;
pub use write::{write_mesh_to, write_particles_to};
