//! BGEO, Houdini's classic binary geometry (version 5), in which SPlisHSPlasH and `splashsurf` keep particles:
//! a reader and a writer.
//!
//! Big-endian: counts, descriptions of the attributes, then one row for each point: x y z w and the attributes.
//! Files may be packed by gzip as a whole, which SPlisHSPlasH does without saying so in the name. *Why own
//! code:* no crate reads it but `splashsurf_lib`, which brings a whole surface reconstruction along; the tests
//! hold a file of its writer.

mod read;
mod write;

pub(crate) use read::read;
pub use read::read_particles;
pub use write::{write_particles, write_particles_to};
