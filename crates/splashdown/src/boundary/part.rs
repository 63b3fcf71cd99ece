//! The parts into which forces are divided, for passes that compute one of them.

/// A part of the forces.
///
/// As a number it is the const parameter `FORCES` of the CPU code of a pass, and the override constant `FORCES` of its
/// WGSL: [`PRESSURE`], [`OTHER`] or [`ALL`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Part {
    /// All forces.
    All,
    /// The pressure force.
    Pressure,
    /// All forces but pressure: viscosity, surface tension, damping, friction, adhesion, contact, body forces.
    Other,
}

/// [`Part::Pressure`].
pub const PRESSURE: u32 = 1;
/// [`Part::Other`].
pub const OTHER: u32 = 2;
/// [`Part::All`].
pub const ALL: u32 = PRESSURE | OTHER;
