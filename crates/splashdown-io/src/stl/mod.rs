//! STL, the format of 3-D printing: separate triangles, as text or binary.
//!
//! The reader joins all solids of a file; corners at the same position become one vertex.
//!
//! *Why own code:* a triangle is fifty bytes, or a few lines. `stl_io` 0.11 reads a binary file whose header begins with
//! `solid` as text (many programs write such files), refuses text whose first line is just `solid`, stops after the
//! first of several solids, and does not merge vertices that differ in the sign of a zero. The tests compare the two
//! readers on files that both read.

mod read;
mod write;

pub(crate) use read::read_mesh;
pub use write::write_mesh_to;
