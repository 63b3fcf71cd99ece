//! Particles and meshes on the host, and what they carry.

mod attribute;
pub(crate) mod columns;
mod mesh;
mod particles;

pub use attribute::Attribute;
pub use mesh::Mesh;
pub(crate) use mesh::{cross, dot, sub};
pub use particles::Particles;
pub(crate) use particles::check_count;
