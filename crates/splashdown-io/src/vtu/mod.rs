//! VTK's XML formats for unstructured grids (`.vtu`) and poly data (`.vtp`), which ParaView, VisIt and `pyvista` open:
//! readers and writers for particles in both, and for meshes as poly data.
//!
//! When writing, each particle is one cell of one point. (With one `VTK_POLY_VERTEX` of all particles, thresholds and
//! selections would not work, because they act on cells.) Arrays follow the XML as raw little-endian bytes, each after
//! its length as UInt64, uncompressed, because compression takes longer than writing.
//!
//! When reading, the points of all pieces are joined, and the polygons of meshes. Other cells and arrays are skipped.
//!
//! *Why own code:* the crate that writes VTK (`vtkio` 0.6) has had no release since March 2025 and copies every array.
//! The XML is parsed by `roxmltree`. Format: VTK User's Guide, "XML File Formats".

mod arrays;
mod decode;
mod file;
mod mesh;
mod read;
mod write;

pub(crate) use mesh::read_mesh;
pub(crate) use read::read;
pub use write::{write_mesh_to, write_particles_to, write_poly_particles_to};
