//! Marching cubes over the marked blocks, with shared vertices.
//!
//! Every node owns the three edges that leave it towards higher coordinates. An edge whose ends are
//! on different sides of the iso level has one vertex. A row of nodes stores its vertices as 24
//! bits (x-edges, y-edges, z-edges), so that the index of a vertex is the first index of the row
//! plus a bit count. No table from edges to vertices is needed, and all cells at an edge find the
//! same vertex. The first indices come from two scans over blocks. A node exactly at the iso level
//! is inside.

mod count;
mod finish;
mod halo;
mod triangles;
mod vertices;

pub(crate) use count::COUNT;
pub(crate) use finish::FINISH;
pub(crate) use triangles::TRIANGLES;
pub(crate) use vertices::VERTICES;
