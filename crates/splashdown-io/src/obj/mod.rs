//! OBJ, Wavefront's text format of vertices and polygons, which every 3-D program reads and writes.
//!
//! The reader reads positions and the faces of all groups; normals, texture coordinates, lines and materials are
//! skipped. A polygon becomes a fan of triangles.
//!
//! *Why own code:* the writer has three kinds of lines, which other crates do not write or format through `core::fmt`.
//! The reader needs only positions and faces. `tobj` 4.0 duplicates the vertices that groups share, so that a closed
//! model of several groups has open edges, and its errors do not contain the line. The tests compare the two readers on
//! files with one group.

mod read;
mod write;

pub(crate) use read::read_mesh;
pub use write::write_mesh_to;
