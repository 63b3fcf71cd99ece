//! What the device knows of probes.

use glam::Vec3;
use splashdown_gpu::{WgslModule, gpu_struct};

/// The WGSL side of this file.
pub const PROBE: WgslModule = WgslModule { name: "sph/probe", source: include_str!("probe.wgsl") };

gpu_struct! {
    /// Something that is measured.
    pub struct ProbePoint {
        /// Where, in m: a point, the foot of a column, the middle of a rectangle.
        position: Vec3,
        /// [`ProbePoint::PRESSURE`], [`ProbePoint::HEIGHT`], [`ProbePoint::FORCE`], [`ProbePoint::FLOW`] or
        /// [`ProbePoint::FLUID`].
        kind: u32,
        /// Unit vector: the normal of a rectangle, the direction of a column.
        normal: Vec3,
        /// Time between two rows in s.
        interval: f32,
        /// Unit vector along a rectangle's first edge.
        along: Vec3,
        /// Half of that edge in m; the height of a column.
        half_along: f32,
        /// Unit vector along a rectangle's second edge.
        across: Vec3,
        /// Half of that edge in m.
        half_across: f32,
        /// Which body.
        body: u32,
        /// Where its rows begin among those of all.
        first_row: u32,
        /// How many rows there is room for.
        most_rows: u32,
        /// Nothing.
        unused: u32,
    }
}

impl ProbePoint {
    /// Pressure at a point.
    pub const PRESSURE: u32 = 0;
    /// Height of the fluid in a column.
    pub const HEIGHT: u32 = 1;
    /// Force and torque on a body.
    pub const FORCE: u32 = 2;
    /// Volume through a rectangle.
    pub const FLOW: u32 = 3;
    /// Sums over the fluid, which the host makes.
    pub const FLUID: u32 = 4;
}

/// A probe's words in the buffer of accounts: what has been summed since its last row.
pub struct Account;

impl Account {
    /// When the next row is due, in s since the frame's beginning; a float's bits.
    pub const NEXT: usize = 0;
    /// Rows since the frame's beginning.
    pub const ROWS: usize = 1;
    /// Time since the last row in s; a float's bits.
    pub const TIME: usize = 2;
    /// The first of [`VALUES`] sums of value times dt; floats' bits.
    pub const SUMS: usize = 3;
    /// Words per probe.
    pub const WORDS: usize = Self::SUMS + VALUES;
}

/// Most values of a probe: a force and a torque.
pub const VALUES: usize = 6;
/// Floats per row: the time since the frame's beginning in s, then the values.
pub const ROW: usize = 1 + VALUES;
