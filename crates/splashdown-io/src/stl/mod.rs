//! STL, the format of 3-D printing: loose triangles, as text or binary.
//!
//! *Why own code:* fifty bytes a triangle, or three kinds of lines that matter. `stl_io` 0.11 takes a binary file
//! whose header begins with `solid` for text (many programs write such), refuses text whose first line is a bare
//! `solid`, ends at the first of several solids, and keeps vertices apart that differ in the sign of a zero. The
//! tests compare the two on files that both read.

mod read;
mod write;

pub use read::read_mesh;
pub use write::{write_mesh, write_mesh_to};
