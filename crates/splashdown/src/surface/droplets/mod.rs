//! Isolated particles: they leave the surface and become droplets.
//!
//! # How it works
//!
//! Two particles are *linked* if they are closer than 0.9 support radii of the field, about the distance at which the
//! surfaces of two lone particles touch. Links form *blobs*. A particle is isolated if it
//!
//! * belongs to a blob of fewer than `min_blob` particles, or
//! * is linked to fewer than `min_neighbours` others, as in a row of single particles.
//!
//! A corner of a film that is one particle thick has three links, one of a film that is two particles thick has seven.
//! Walls do not count: a particle that lies alone on the floor is isolated.
//!
//! 1. `classify`: each particle follows links until it has found `min_blob` particles or the end of its blob.
//!    Particles inside the fluid find them within their own cell.
//! 2. A scan numbers the particles that remain; `separate` copies them to an array of their own and lists the others.
//! 3. `kept_cells`: where each cell begins in that array. All other passes of the surface read it instead of the
//!    particles of the simulation, so isolated particles cost no blocks, vertices or triangles.
//!
//! A droplet is a sphere with the volume of its particle, [`droplet_radius`]. The mesh, with isotropic kernels and cells
//! of half a spacing, has 0.67 of the volume of lone particles and 1.5 times that of rows of single particles
//! (`examples/droplet_volume.rs`, splash of the scene `double-dam-break`).
//!
//! # Why not the other way
//!
//! * *Small components of the mesh*: their volume depends on their place in the cells, they have to be found on the
//!   host, and their particles have to be found again.
//! * *Labels* that spread from particle to particle: one pass per link of the longest chain.
//! * *Only the number of neighbours*: a ball of eight particles has as many as the edge of a film.

mod classify;
mod host;
mod kept_cells;
mod separate;
#[cfg(test)]
mod tests;

pub(crate) use classify::CLASSIFY;
pub use host::{droplets_of, isolated};
pub(crate) use kept_cells::KEPT_CELLS;
pub(crate) use separate::SEPARATE;

use glam::Vec3;
use splashdown_gpu::gpu_struct;

/// Largest `min_blob` and `min_neighbours`.
pub const MAX_BLOB: u32 = 32;
/// Largest distance of linked particles in support radii.
pub(super) const LINK: f32 = 0.9;

gpu_struct! {
    /// An isolated particle.
    pub struct Droplet {
        /// Position in m.
        position: Vec3,
        /// Id of the particle.
        id: u32,
        /// Velocity in m/s.
        velocity: Vec3,
        /// Unused.
        padding: u32,
    }
}

/// The radius in m of a droplet with the volume of a particle, `particle_spacing^3`.
pub fn droplet_radius(particle_spacing: f32) -> f32 {
    particle_spacing * (0.75 / std::f32::consts::PI).cbrt()
}
