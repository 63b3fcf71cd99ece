//! Particles and meshes in host memory, and their attributes.

mod attribute;
pub(crate) mod columns;
pub(crate) mod info;
mod mesh;
mod particles;

pub use attribute::Attribute;
pub use info::ParticleInfo;
pub use mesh::Mesh;
pub(crate) use mesh::{cross, dot, sub};
pub use particles::Particles;
