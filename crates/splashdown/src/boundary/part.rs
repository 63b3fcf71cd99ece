//! The parts into which forces are divided, for passes that compute one of them.
//!
//! A part is the const parameter `FORCES` of a pass's CPU code, and the override constant `FORCES` of its WGSL.

/// The pressure force.
pub const PRESSURE: u32 = 1;
/// All forces but pressure: viscosity, surface tension, damping, friction, adhesion, contact, body forces.
pub const OTHER: u32 = 2;
/// All forces.
pub const ALL: u32 = PRESSURE | OTHER;
