//! BGEO, Houdini's classic binary geometry (version 5), in which SPlisHSPlasH and `splashsurf` store particles: a reader
//! and a writer.
//!
//! The format is big-endian: counts, descriptions of the attributes, then one row per point with x y z w and the
//! attributes. Attributes of the whole (`time`, `particle_spacing`) follow, which are read from files without primitives.
//! The whole file may be compressed by gzip; SPlisHSPlasH does so without `.gz` in the name.
//!
//! *Why own code:* the only crate that reads it is `splashsurf_lib`, a complete surface reconstruction. The tests read a
//! file that it has written.

mod read;
mod write;

pub(crate) use read::read;
pub use write::write_particles_to;
