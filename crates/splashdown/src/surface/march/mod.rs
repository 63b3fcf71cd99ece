//! Marching cubes over the marked blocks, with shared vertices.
//!
//! Every node owns the three edges that leave it towards higher coordinates. Where an edge's ends lie on
//! different sides of the iso level it carries one vertex. A row of nodes keeps its vertices as 24 bits
//! (x-edges, y-edges, z-edges), so that a vertex's number is the row's first number plus a count of bits: no
//! table from edges to vertices is needed, and all cells at an edge find the same vertex. The numbers come
//! from two scans over blocks. A node at the iso level exactly counts as inside, everywhere.

mod count;
mod finish;
mod halo;
mod triangles;
mod vertices;

pub(crate) use count::COUNT;
pub(crate) use finish::FINISH;
pub(crate) use triangles::TRIANGLES;
pub(crate) use vertices::VERTICES;
