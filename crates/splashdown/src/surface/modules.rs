//! The pieces of WGSL that the surface's passes share.

use splashdown_gpu::WgslModule;

/// The neighbour grid.
pub(crate) use crate::cells::GRID;

/// The mesh's size, as the device knows it.
pub(crate) const STATUS: WgslModule =
    WgslModule { name: "surface/status", source: include_str!("status.wgsl") };
/// The lattice, and where blocks and nodes lie.
pub(crate) const LATTICE: WgslModule =
    WgslModule { name: "surface/lattice", source: include_str!("lattice.wgsl") };
/// From a block's place to its data.
pub(crate) const SLOTS: WgslModule = WgslModule { name: "surface/slots", source: include_str!("slots.wgsl") };
/// The cubic spline.
pub(crate) const SPLINE: WgslModule =
    WgslModule { name: "surface/spline", source: include_str!("spline.wgsl") };
/// The cells that a box touches.
pub(crate) const CANDIDATES: WgslModule =
    WgslModule { name: "surface/candidates", source: include_str!("candidates.wgsl") };
/// A number of workgroups in two dimensions.
pub(crate) const SPREAD: WgslModule =
    WgslModule { name: "surface/spread", source: include_str!("spread.wgsl") };
/// Which nodes of a row are inside, one bit each.
pub(crate) const SIGNS: WgslModule = WgslModule { name: "surface/signs", source: include_str!("signs.wgsl") };
