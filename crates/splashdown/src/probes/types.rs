//! The elements of the buffers of probes.

use glam::Vec3;
use splashdown_gpu::{WgslModule, gpu_struct};

/// The WGSL side of this file.
pub const PROBE: WgslModule = WgslModule { name: "sph/probe", source: include_str!("probe.wgsl") };

gpu_struct! {
    /// A probe on the device.
    pub struct ProbePoint {
        /// Position in m: of a point, of the base of a column, or of the centre of a rectangle.
        position: Vec3,
        /// [`ProbePoint::PRESSURE`], [`ProbePoint::HEIGHT`], [`ProbePoint::FORCE`], [`ProbePoint::FLOW`],
        /// [`ProbePoint::FLUID`] or [`ProbePoint::BODY`].
        kind: u32,
        /// Unit vector: the normal of a rectangle, the direction of a column.
        normal: Vec3,
        /// Time between two rows in s.
        interval: f32,
        /// Unit vector along the first edge of a rectangle.
        along: Vec3,
        /// Half the length of this edge in m; or the height of a column.
        half_along: f32,
        /// Unit vector along the second edge of a rectangle.
        across: Vec3,
        /// Half the length of this edge in m.
        half_across: f32,
        /// Index of the body.
        body: u32,
        /// Index of its first row among the rows of all probes.
        first_row: u32,
        /// Number of rows for which there is room.
        most_rows: u32,
        /// Padding.
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
    /// Sums over the fluid, which the host computes.
    pub const FLUID: u32 = 4;
    /// Pose and velocity of a body, and force and torque on it.
    pub const BODY: u32 = 5;

    /// True if its values are the force and the torque on a body.
    pub fn has_force(&self) -> bool {
        matches!(self.kind, Self::FORCE | Self::BODY)
    }

    /// Floats between the time and the mean values in its rows: [`POSE`] of a body.
    pub fn pose_length(&self) -> usize {
        if self.kind == Self::BODY { POSE } else { 0 }
    }
}

/// The words of a probe in the buffer of accounts, which accumulates values since the last row.
pub struct Account;

impl Account {
    /// Time at which the next row is due, in s since the beginning of the frame, as the bits of a float.
    pub const NEXT: usize = 0;
    /// Number of rows since the beginning of the frame.
    pub const ROWS: usize = 1;
    /// Time since the last row in s, as the bits of a float.
    pub const TIME: usize = 2;
    /// The first of [`VALUES`] sums of value times dt, as the bits of floats.
    pub const SUMS: usize = 3;
    /// Words per probe.
    pub const WORDS: usize = Self::SUMS + VALUES;
}

/// The largest number of values of a probe of which the mean is written: those of a force and a torque.
pub const VALUES: usize = 6;
/// Floats of a pose: position, quaternion x, y, z, w, velocity and angular velocity.
pub const POSE: usize = 13;
/// Floats per row: the time since the beginning of the frame in s, the pose if the probe has one, then the mean values.
pub const ROW: usize = 1 + POSE + VALUES;
