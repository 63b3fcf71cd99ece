//! WGSL modules shared by the surface passes.

use splashdown_gpu::WgslModule;

/// The neighbour grid.
pub(crate) use crate::cells::GRID;

/// The walls at which the surface ends.
pub(crate) use super::walls::WGSL as WALLS;

/// The size of the mesh.
pub(crate) const STATUS: WgslModule =
    WgslModule { name: "surface/status", source: include_str!("status.wgsl") };
/// The lattice, and the positions of blocks and nodes.
pub(crate) const LATTICE: WgslModule =
    WgslModule { name: "surface/lattice", source: include_str!("lattice.wgsl") };
/// The slot of the block at given coordinates.
pub(crate) const SLOTS: WgslModule = WgslModule { name: "surface/slots", source: include_str!("slots.wgsl") };
/// The range of cells that intersect a box.
pub(crate) const CANDIDATES: WgslModule =
    WgslModule { name: "surface/candidates", source: include_str!("candidates.wgsl") };
/// The signs of the nodes of a row, one bit each.
pub(crate) const SIGNS: WgslModule = WgslModule { name: "surface/signs", source: include_str!("signs.wgsl") };
