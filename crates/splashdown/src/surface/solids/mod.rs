//! Bodies: the surface of the fluid touches them and does not enter them.
//!
//! Particles keep half a spacing from bodies, and the field is too low there, because the kernel reaches into the solid.
//!
//! 1. `clip`, after the field: completes the field up to the bodies and ends it there. The mesh stays closed.
//! 2. `pin`, before smoothing: vertices on bodies keep their places. Smoothing ignores them as neighbours, like those on
//!    walls, so that they do not pull the edge of the free surface down; their neighbours move less, so that no triangle
//!    turns over.
//!
//! The distances come from the maps of the bodies, so the surface of bodies in motion costs as much as that of static ones.
//! Only a simulation has maps: the surface of particles in files ends half a spacing before bodies.
//!
//! # Why not the other way
//!
//! Images of the particles, as behind walls, need the closest point of the body for each of them. Moving the vertices of
//! the finished mesh to the body can turn triangles over.

mod clip;
mod pin;
#[cfg(test)]
mod tests;

pub(crate) use clip::CLIP;
pub(crate) use pin::PIN;
