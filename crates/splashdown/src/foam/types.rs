//! What the foam's passes share: constants, state, the particles themselves.

use glam::Vec3;
use splashdown_gpu::gpu_struct;

gpu_struct! {
    /// What does not change while foam is computed. SI units.
    pub struct FoamParams {
        /// Most diffuse particles.
        capacity: u32,
        /// Shortest time between two updates within a frame, in seconds.
        interval: f32,
        /// Diffuse particles per second from a particle of the fluid that traps air as well as it can.
        trapped_air: f32,
        /// The same from a wave's crest.
        wave_crest: f32,
        /// Where trapped air begins to count, in m/s.
        trapped_air_least: f32,
        /// One over the range from there to where it counts fully, in s/m.
        trapped_air_scale: f32,
        /// Where a crest's curvature begins to count; without unit.
        wave_crest_least: f32,
        /// One over the range from there to where it counts fully.
        wave_crest_scale: f32,
        /// Where the kinetic energy begins to count, in J/kg.
        energy_least: f32,
        /// One over the range from there to where it counts fully, in kg/J.
        energy_scale: f32,
        /// Shortest lifetime of foam in seconds.
        lifetime_least: f32,
        /// The longest one is longer by this many seconds.
        lifetime_range: f32,
        /// Buoyancy of a bubble in multiples of gravity.
        buoyancy: f32,
        /// How quickly a bubble takes the water's velocity, in 1/s.
        drag: f32,
        /// Spray has fewer neighbours in the fluid.
        spray_below: f32,
        /// A bubble has more.
        bubble_above: f32,
        /// Foam has more where it becomes a bubble: less than this, or it would be both by turns.
        bubble_again_above: f32,
    }
}

gpu_struct! {
    /// What changes from update to update; decided on the device.
    pub struct FoamState {
        /// The simulated time of the last update in seconds.
        time: f32,
        /// Its time step in seconds.
        dt: f32,
        /// 1 if there is something to do, 0 if not: then no pass touches the particles.
        is_due: u32,
        /// 1 once the simulation's time has been looked at.
        has_begun: u32,
        /// Updates so far.
        step: u32,
        /// Diffuse particles there are.
        count: u32,
        /// How many of those before the last update are left.
        kept: u32,
        /// How many were born in it.
        born: u32,
        /// The part of those that wanted to be born that found room, times 4096, in the lower 16 bits; in the
        /// upper ones s, where 2^s share one such chance.
        share: u32,
        /// How many have been born so far, which is the number of the next one.
        next_id: u32,
        /// How many found no room so far.
        refused: u32,
        /// How many wanted to be born in the last update.
        wanted: u32,
    }
}

gpu_struct! {
    /// A diffuse particle.
    pub struct Diffuse {
        /// Its place in metres.
        position: Vec3,
        /// How long it still lives as foam, in seconds.
        lifetime: f32,
        /// Its velocity in m/s.
        velocity: Vec3,
        /// Its number in order of birth, times four, and its [kind](Self::kind).
        tag: u32,
    }
}

/// What a diffuse particle is, by how much fluid is round it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum DiffuseKind {
    /// A drop in the air: it flies as it was thrown.
    Spray = 0,
    /// On the surface: it goes where the water goes, and dissolves.
    Foam = 1,
    /// Under water: it goes with the water and rises.
    Bubble = 2,
}

impl DiffuseKind {
    /// All kinds, with what several of them are called.
    pub const ALL: [(Self, &'static str); 3] =
        [(Self::Spray, "spray"), (Self::Foam, "foam"), (Self::Bubble, "bubbles")];
}

impl Diffuse {
    /// What it is.
    pub fn kind(&self) -> DiffuseKind {
        match self.tag & 3 {
            0 => DiffuseKind::Spray,
            1 => DiffuseKind::Foam,
            _ => DiffuseKind::Bubble,
        }
    }

    /// Its number in order of birth, modulo 2^30.
    pub fn id(&self) -> u32 {
        self.tag >> 2
    }
}

/// Most diffuse particles from one particle of the fluid in one update.
const MOST_BORN: f32 = 64.0;

impl FoamParams {
    /// The kind of a particle with so many neighbours in the fluid.
    pub(super) fn kind_of(&self, neighbours: f32, was_foam: bool) -> DiffuseKind {
        let bubble_above = if was_foam { self.bubble_again_above } else { self.bubble_above };
        if neighbours < self.spray_below {
            DiffuseKind::Spray
        } else if neighbours > bubble_above {
            DiffuseKind::Bubble
        } else {
            DiffuseKind::Foam
        }
    }

    /// How many diffuse particles are to be expected of a particle of the fluid with these potentials in `dt`
    /// seconds.
    pub(super) fn expected(&self, potentials: glam::Vec4, dt: f32) -> f32 {
        let trapped = self.trapped_air * ramp(potentials.x, self.trapped_air_least, self.trapped_air_scale);
        let crest = self.wave_crest * ramp(potentials.y, self.wave_crest_least, self.wave_crest_scale);
        let expected = ramp(potentials.z, self.energy_least, self.energy_scale) * (trapped + crest) * dt;
        expected.min(MOST_BORN)
    }
}

fn ramp(value: f32, least: f32, scale: f32) -> f32 {
    ((value - least) * scale).clamp(0.0, 1.0)
}

/// The PCG hash of M. Jarzynski and M. Olano, "Hash functions for GPU rendering", JCGT 9 (2020).
fn hash(i: u32) -> u32 {
    let state = i.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (word >> 22) ^ word
}

/// A number in [0, 1) that looks random: the same bits everywhere, for 24 bits fit a float.
pub(super) fn unit(i: u32) -> f32 {
    (hash(i) >> 8) as f32 * (1.0 / 16_777_216.0)
}

/// Where the random numbers of a particle of the fluid in an update begin.
pub(super) fn seed_of(id: u32, step: u32) -> u32 {
    hash(id ^ hash(step))
}

/// Where the m-th of those that want to be born goes if a [`FoamState::share`] of them finds room: k f / 4096,
/// rounded down, without overflow, where f are the share's lower bits and k is m / 2^s. Two that follow one
/// another are at most one apart; of several at one place the last is born.
pub(super) fn place_of(m: u32, share: u32) -> u32 {
    let (k, part) = (m >> (share >> 16), share & 0xffff);
    (k >> 12) * part + (((k & 4095) * part) >> 12)
}
