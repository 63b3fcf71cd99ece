//! The elements of the buffers of emitters and sinks.

use glam::{UVec3, Vec2, Vec3};
use splashdown_gpu::gpu_struct;

gpu_struct! {
    /// The nozzle of an emitter: a straight pipe from its back face to the outlet.
    pub struct Nozzle {
        /// Centre of the back face in m.
        back: Vec3,
        /// Speed of the fluid in m/s.
        speed: f32,
        /// Unit vector from the back face to the outlet.
        direction: Vec3,
        /// Length in m.
        length: f32,
        /// Unit vector across the direction, horizontal.
        across: Vec3,
        /// Start of the emission in s.
        start: f32,
        /// Unit vector along `direction` x `across`.
        up: Vec3,
        /// End of the emission in s.
        end: f32,
        /// Radius of a disc, or half the width along `across`, in m.
        half_across: f32,
        /// Half the height along `up`, in m.
        half_up: f32,
        /// Index of the first point of its layer among the points of all nozzles.
        first_point: u32,
        /// Particles in a layer.
        points: u32,
        /// Largest number of particles that it creates.
        most: u32,
        /// 1 for a disc, 0 for a rectangle.
        disc: u32,
        /// Distance between layers in m.
        interval: f32,
        /// How far, at most, its particles are created beside their columns, in m.
        wobble: f32,
        /// Share of the stretching of a jet in air that is its contraction along `across`.
        share_across: f32,
        /// The same along `up`.
        share_up: f32,
        /// Rate at which gravity stretches a jet over the gravity along it, in s/m.
        stretching: f32,
        /// Number of particles beside the pipe from which its outlet is under water; fewer are that share of it.
        submerged_at: f32,
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
        /// Distance between the nodes of a map in m.
        cell_size: f32,
        /// Nodes of a map along x, y, z; x fastest.
        nodes: UVec3,
        /// Index of the first node of the map among the nodes of all maps.
        first_node: u32,
    }
}

impl Nozzle {
    /// A point in m as distances from the centre of the back face along `across`, `up` and `direction`.
    #[inline]
    pub fn local(&self, x: Vec3) -> Vec3 {
        let o = x - self.back;
        Vec3::new(o.dot(self.across), o.dot(self.up), o.dot(self.direction))
    }

    /// True if a point in m lies in the pipe, or up to a quarter of a spacing behind its back face: rounding must not
    /// exclude a layer that was created there.
    #[inline]
    pub fn holds(&self, x: Vec3, particle_spacing: f32) -> bool {
        let q = self.local(x);
        self.is_within(q, 0.0) && q.z >= -0.25 * particle_spacing && q.z <= self.length
    }

    /// True if a point in m is outside the pipe and less than one and a half spacings from its sides, and the jet contracts.
    #[inline]
    pub fn is_beside(&self, x: Vec3, particle_spacing: f32) -> bool {
        let q = self.local(x);
        let is_near = q.z >= 0.0 && q.z <= self.length && self.is_within(q, Self::REACH * particle_spacing);
        is_near && !self.is_within(q, 0.0) && (self.share_across != 0.0 || self.share_up != 0.0)
    }

    /// Distance from the pipe in spacings within which particles are beside it.
    pub const REACH: f32 = 1.5;

    /// The largest velocity of the rim of a jet across its direction, over its speed.
    pub const MOST_CONTRACTION: f32 = 0.5;

    /// Whether a place is within the cross-section, enlarged by `margin` (m) on all sides.
    #[inline]
    fn is_within(&self, q: Vec3, margin: f32) -> bool {
        let (across, up) = (self.half_across + margin, self.half_up + margin);
        if self.disc == 1 {
            q.x * q.x + q.y * q.y <= across * across
        } else {
            q.x.abs() <= across && q.y.abs() <= up
        }
    }

    /// The velocity in m/s that a particle in the pipe has after a step of `dt` (s): that of the piston. If it leaves in
    /// this step, it also contracts, with `beside` particles beside the pipe and gravity in m/s^2.
    #[inline]
    pub fn velocity(&self, x: Vec3, gravity: Vec3, dt: f32, beside: u32) -> Vec3 {
        let q = self.local(x);
        let piston = self.speed * self.direction;
        if q.z + self.speed * dt <= self.length {
            return piston;
        }
        let rate = self.stretching * gravity.dot(self.direction);
        let inwards = |share: f32, half: f32| {
            let most = Self::MOST_CONTRACTION * self.speed / half;
            (share * rate).clamp(-most, most)
        };
        let in_air = 1.0 - (beside as f32 / self.submerged_at).min(1.0);
        let across = in_air * inwards(self.share_across, self.half_across) * q.x;
        let up = in_air * inwards(self.share_up, self.half_up) * q.y;
        piston - across * self.across - up * self.up
    }
}

impl Nozzle {
    /// The place of a particle in a square of [-1, 1], by its id: the sequence R2 of Roberts (2018), which does not repeat.
    #[inline]
    pub fn beside(id: u32) -> Vec2 {
        let fraction = |step: u32| (id.wrapping_mul(step) >> 8) as f32 * (2.0 / 16_777_216.0) - 1.0;
        Vec2::new(fraction(Self::STEPS[0]), fraction(Self::STEPS[1]))
    }

    /// The steps of the sequence in units of 2^-32: 1/p and 1/p^2 for the plastic number p.
    const STEPS: [u32; 2] = [3_242_174_889, 2_447_445_414];
}

impl SinkShape {
    /// The interior of a box.
    pub const BOX: u32 = 0;
    /// The half-space behind a plane.
    pub const BELOW: u32 = 1;
    /// The region in which a map of signed distances is negative.
    pub const MAP: u32 = 2;

    /// Whether it removes a particle at a point in m; `maps` are the nodes of all maps in m.
    pub fn takes(&self, maps: &[f32], x: Vec3) -> bool {
        if self.kind == Self::BELOW {
            return (x - self.low).dot(self.high) < 0.0;
        }
        let inside = x.cmpge(self.low).all() && x.cmple(self.high).all();
        if self.kind == Self::BOX || !inside {
            return inside;
        }
        let at = (x - self.low) / self.cell_size;
        let c = at.as_uvec3().min(self.nodes - UVec3::splat(2));
        let f = at - c.as_vec3();
        let (row, plane) = (self.nodes.x as usize, (self.nodes.x * self.nodes.y) as usize);
        let first = self.first_node as usize + c.z as usize * plane + c.y as usize * row + c.x as usize;
        let mix = |a: f32, b: f32, t: f32| a * (1.0 - t) + b * t;
        let sides = [first, first + plane]
            .map(|k| mix(mix(maps[k], maps[k + 1], f.x), mix(maps[k + row], maps[k + row + 1], f.x), f.y));
        mix(sides[0], sides[1], f.z) < 0.0
    }
}

/// The words of an emitter in the buffer of schedules. The next unused id follows the words of the last emitter.
pub struct EmissionSchedule;

impl EmissionSchedule {
    /// Distance since the last layer in m, as the bits of a float.
    pub const PHASE: usize = 0;
    /// Particles created so far.
    pub const EMITTED: usize = 1;
    /// Particles not created because the buffers are full.
    pub const REFUSED: usize = 2;
    /// Particles to create in this step: those of a layer, or none.
    pub const LAYER: usize = 3;
    /// Index of the first of them in the arrays.
    pub const SLOT: usize = 4;
    /// Id of the first of them.
    pub const ID: usize = 5;
    /// Their distance from the back face in m, as the bits of a float.
    pub const DISTANCE: usize = 6;
    /// Particles not created because another particle was too near.
    pub const BLOCKED: usize = 7;
    /// Particles [beside the pipe](Nozzle::is_beside), counted during a step.
    pub const COUNTED: usize = 8;
    /// Their number in the step before.
    pub const BESIDE: usize = 9;
    /// Words per emitter.
    pub const WORDS: usize = 10;
}
