//! Which blocks of 8x8x8 nodes the fluid can reach.
//!
//! A particle marks every block in the box of nodes within its support, and one node below: that is where the
//! cells lie that touch these nodes. So all nodes with a value other than zero, and the owners of all edges
//! the surface may cut, lie in marked blocks. The marked blocks are numbered in the order of their place;
//! `block_slot` gives the number of the block at a place or `NONE`, `block_list` the place of the block with
//! a number.

mod compact;
mod mark;
mod plan;

pub(crate) use compact::COMPACT;
pub(crate) use mark::MARK;
pub(crate) use plan::PLAN;
