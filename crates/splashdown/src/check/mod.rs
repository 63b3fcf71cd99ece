//! Loads scene files and checks them together with the files that they name.
//!
//! [`scene`](crate::scene) reads and checks values. This module reads the meshes and particle files, creates
//! the particles, and reports problems with their lines. The results stay with the scene (`Built`), so that a
//! simulation of that scene does not repeat the work.

mod built;
mod derived;
mod files;
mod flow;
mod load;
mod located;
mod motion;
mod obstacles;
mod placed;
mod reference;
mod resolution;
mod shapes;
#[cfg(test)]
mod tests;
mod validated;
mod warnings;

pub(crate) use built::Built;
pub use built::count;
pub use reference::reference;
pub use resolution::{BodyWidths, Extent, Resolution, Wave, resolution};
pub use shapes::{Closing, Interpretation, interpretations};
pub use validated::Validated;
