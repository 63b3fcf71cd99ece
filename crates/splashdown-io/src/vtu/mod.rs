//! VTU, VTK's XML format for unstructured grids, as ParaView, VisIt and `pyvista` open it: a writer and a reader for
//! particles. The reader takes `.vtp` (poly data) too.
//!
//! Each particle is one `VTK_VERTEX` cell (not one `VTK_POLY_VERTEX` for all: thresholds and selections work on
//! cells). Arrays follow the XML as raw little-endian bytes, each behind its length as UInt64, uncompressed:
//! compression would take longer than the disk.
//!
//! *Why own code:* the crate that writes VTK (`vtkio` 0.6) last moved in March 2025, wants its own copy of every
//! array and offers much that is not needed; the need is these lines. The XML itself is parsed by `roxmltree`. Format:
//! VTK User's Guide, "XML File Formats".

mod decode;
mod read;
mod write;

pub(crate) use read::read;
pub use read::read_particles;
pub use write::{write_particles, write_particles_to};
