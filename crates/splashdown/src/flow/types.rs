//! What the device knows of emitters and sinks.

use glam::{UVec2, UVec3, Vec3};
use splashdown_gpu::gpu_struct;

gpu_struct! {
    /// An emitter's nozzle: a straight piece of pipe from its back face to the outlet.
    pub struct Nozzle {
        /// Middle of the back face in m.
        back: Vec3,
        /// Speed of the fluid in m/s.
        speed: f32,
        /// Unit vector from the back face to the outlet.
        direction: Vec3,
        /// Length in m.
        length: f32,
        /// Unit vector across the direction, horizontal.
        across: Vec3,
        /// When it begins, in s.
        start: f32,
        /// Unit vector along `direction` x `across`.
        up: Vec3,
        /// When it ends, in s.
        end: f32,
        /// Radius of a disc, or half the width along `across`, in m.
        half_across: f32,
        /// Half the height along `up`, in m.
        half_up: f32,
        /// Where its layer begins among the points of all.
        first_point: u32,
        /// Particles in a layer.
        points: u32,
        /// Most particles that it makes.
        most: u32,
        /// 1 for a disc, 0 for a rectangle.
        disc: u32,
        /// Nothing.
        unused: UVec2,
    }
}

gpu_struct! {
    /// A sink.
    pub struct SinkShape {
        /// Lower corner of a box or of a map, or a point of a plane, in m.
        low: Vec3,
        /// [`SinkShape::BOX`], [`SinkShape::BELOW`] or [`SinkShape::MAP`].
        kind: u32,
        /// Upper corner in m, or the plane's normal.
        high: Vec3,
        /// Distance of a map's nodes in m.
        cell_size: f32,
        /// Nodes of a map along x, y, z; x fastest.
        nodes: UVec3,
        /// Where the map begins among those of all.
        first_node: u32,
    }
}

impl Nozzle {
    /// True if a point in m lies in the pipe, a quarter of a spacing behind its back face included: rounding
    /// must not leave a layer out that was born right there.
    #[inline]
    pub fn holds(&self, x: Vec3, particle_spacing: f32) -> bool {
        let o = x - self.back;
        let (along, a, b) = (o.dot(self.direction), o.dot(self.across), o.dot(self.up));
        let inside = if self.disc == 1 {
            a * a + b * b <= self.half_across * self.half_across
        } else {
            a.abs() <= self.half_across && b.abs() <= self.half_up
        };
        inside && along >= -0.25 * particle_spacing && along <= self.length
    }
}

impl SinkShape {
    /// A box.
    pub const BOX: u32 = 0;
    /// The half-space behind a plane.
    pub const BELOW: u32 = 1;
    /// Where a map of signed distances is negative.
    pub const MAP: u32 = 2;
}

/// One emitter's words in the buffer of schedules; behind the last emitter's comes the next id to give.
pub struct EmissionSchedule;

impl EmissionSchedule {
    /// Distance since the last layer in m; a float's bits.
    pub const PHASE: usize = 0;
    /// Particles made so far.
    pub const EMITTED: usize = 1;
    /// Particles for which there was no room.
    pub const REFUSED: usize = 2;
    /// Particles to make in this step: a layer, or none.
    pub const LAYER: usize = 3;
    /// Where they go.
    pub const SLOT: usize = 4;
    /// The id of the first.
    pub const ID: usize = 5;
    /// How far in front of the back face they are born, in m; a float's bits.
    pub const DISTANCE: usize = 6;
    /// Particles not made because another one was in the way.
    pub const BLOCKED: usize = 7;
    /// Words per emitter.
    pub const WORDS: usize = 8;
}
