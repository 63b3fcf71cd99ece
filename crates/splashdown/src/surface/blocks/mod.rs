//! The blocks of 8x8x8 nodes within reach of the fluid.
//!
//! A particle marks every block that overlaps the box of nodes within its support, extended by one
//! node towards lower coordinates, because the cells that touch these nodes begin there. All nodes
//! with a non-zero value, and the owners of all edges that the surface can cut, are therefore in
//! marked blocks. The marked blocks are numbered in the order of the dense table: `block_slot` maps
//! a place in the table to the number of the block, or to `NONE`; `block_list` maps the number to
//! the place.

mod compact;
mod mark;
mod plan;

pub(crate) use compact::COMPACT;
pub(crate) use mark::MARK;
pub(crate) use plan::PLAN;
