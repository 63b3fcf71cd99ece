//! From scene files to checked scenes, and to what is built from them.
//!
//! [`scene`](crate::scene) reads values; this module compares them with the files that a scene names, with their meshes
//! and with the lattices of particles, and reports what is wrong at its line. What it reads, fills and builds on the way
//! stays with the scene (`Built`), so that a simulation of that scene does not do it again.

mod built;
mod derived;
mod files;
mod load;
mod reference;
#[cfg(test)]
mod tests;
mod warnings;

pub(crate) use built::Built;
pub use built::count;
pub use reference::reference;
