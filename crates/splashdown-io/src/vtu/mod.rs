//! VTU, VTK's XML format for unstructured grids, which ParaView, VisIt and `pyvista` open: a writer and a reader for
//! particles. The reader also accepts `.vtp` (poly data).
//!
//! When writing, each particle is one `VTK_VERTEX` cell. (With one `VTK_POLY_VERTEX` of all particles, thresholds and
//! selections would not work, because they act on cells.) Arrays follow the XML as raw little-endian bytes, each after
//! its length as UInt64, uncompressed, because compression takes longer than writing.
//!
//! When reading, the points of all pieces are joined. Cells and other arrays are skipped.
//!
//! *Why own code:* the crate that writes VTK (`vtkio` 0.6) has had no release since March 2025 and copies every array.
//! The XML is parsed by `roxmltree`. Format: VTK User's Guide, "XML File Formats".

mod decode;
mod read;
mod write;

pub(crate) use read::read;
pub use write::write_particles_to;
