//! Legacy VTK files (`.vtk`), which every program of the VTK family opens: a reader for points and a writer for
//! particles and meshes.
//!
//! *Why own code:* `vtkio` 0.6 rests on a parser of 2017 (`nom` 3), has not moved since March 2025 and reads
//! whole files into its own model of every kind of grid. Points and their arrays are the need. Format: VTK
//! User's Guide, "Simple Legacy Formats", and what VTK 9 writes beyond it (`METADATA`, cells as `OFFSETS` and
//! `CONNECTIVITY`).

mod read;
mod write;

pub(crate) use read::read;
pub use read::read_particles;
pub use write::{write_mesh, write_mesh_to, write_particles, write_particles_to};
