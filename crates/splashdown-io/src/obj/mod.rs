//! OBJ, the text format of Wavefront that every 3-D program reads and writes: vertices and polygons.
//!
//! *Why own code:* the writer is three kinds of lines, which the known crates do not write or build through
//! `core::fmt`. The reader needs positions and faces only. `tobj` 4.0 gives every group of a file vertices of its
//! own, so that a closed model of several groups comes back cut open along their seams, and its errors name no line;
//! the tests compare the two on files of one group.

mod read;
mod write;

pub use read::read_mesh;
pub use write::{write_mesh, write_mesh_to};
