//! Constants, state and particles, shared by the foam passes.

use glam::Vec3;
use splashdown_gpu::gpu_struct;

gpu_struct! {
    /// Constants of the foam. SI units.
    pub struct FoamParams {
        /// Largest number of diffuse particles.
        capacity: u32,
        /// Shortest time between two updates within a frame, in seconds.
        interval: f32,
        /// Diffuse particles per second from a fluid particle with the full potential of trapped
        /// air.
        trapped_air: f32,
        /// Diffuse particles per second from a fluid particle with the full potential of a wave
        /// crest.
        wave_crest: f32,
        /// Lower limit of trapped air, in m/s.
        trapped_air_least: f32,
        /// Reciprocal of the range to the upper limit, in s/m.
        trapped_air_scale: f32,
        /// Lower limit of the curvature of a wave crest, dimensionless.
        wave_crest_least: f32,
        /// Reciprocal of the range to the upper limit.
        wave_crest_scale: f32,
        /// Lower limit of the kinetic energy, in J/kg.
        energy_least: f32,
        /// Reciprocal of the range to the upper limit, in kg/J.
        energy_scale: f32,
        /// Shortest lifetime of foam in seconds.
        lifetime_least: f32,
        /// Difference between the longest and the shortest lifetime in seconds.
        lifetime_range: f32,
        /// Buoyancy of a bubble in multiples of gravity.
        buoyancy: f32,
        /// Rate at which the velocity of a bubble relaxes to that of the fluid, in 1/s.
        drag: f32,
        /// Particles with fewer neighbours in the fluid are spray.
        spray_below: f32,
        /// Particles with more neighbours are bubbles.
        bubble_above: f32,
        /// Foam with more neighbours becomes a bubble. The higher limit prevents flickering between
        /// the two.
        bubble_again_above: f32,
    }
}

gpu_struct! {
    /// State of the foam, updated on the device.
    pub struct FoamState {
        /// The simulated time of the last update in seconds.
        time: f32,
        /// Time step of the update in seconds.
        dt: f32,
        /// 1 if an update is due. If 0, no pass accesses the particles.
        is_due: u32,
        /// 1 once `time` has been initialised.
        has_begun: u32,
        /// Number of updates.
        step: u32,
        /// Number of diffuse particles.
        count: u32,
        /// Number of particles that remained in the last update.
        kept: u32,
        /// Number of particles generated in it.
        born: u32,
        /// Fraction of the candidates that were accepted, times 4096, in the lower 16 bits. In the
        /// upper bits s: 2^s candidates share one slot.
        share: u32,
        /// Number of particles generated so far, which is the id of the next one.
        next_id: u32,
        /// Number of rejected candidates so far.
        refused: u32,
        /// Number of candidates in the last update.
        wanted: u32,
    }
}

gpu_struct! {
    /// A diffuse particle.
    pub struct Diffuse {
        /// Position in metres.
        position: Vec3,
        /// Remaining lifetime as foam, in seconds.
        lifetime: f32,
        /// Velocity in m/s.
        velocity: Vec3,
        /// Four times the [id](Self::id), plus the [kind](Self::kind).
        tag: u32,
    }
}

/// The kind of a diffuse particle, determined by the amount of fluid around it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum DiffuseKind {
    /// A drop in the air on a ballistic trajectory.
    Spray = 0,
    /// On the surface: advected with the fluid, and dissolves.
    Foam = 1,
    /// Under water: advected with the fluid, and rises.
    Bubble = 2,
}

impl DiffuseKind {
    /// All kinds, with their plural names.
    pub const ALL: [(Self, &'static str); 3] =
        [(Self::Spray, "spray"), (Self::Foam, "foam"), (Self::Bubble, "bubbles")];
}

impl Diffuse {
    /// The kind.
    pub fn kind(&self) -> DiffuseKind {
        match self.tag & 3 {
            0 => DiffuseKind::Spray,
            1 => DiffuseKind::Foam,
            _ => DiffuseKind::Bubble,
        }
    }

    /// Consecutive number in the order of generation, modulo 2^30.
    pub fn id(&self) -> u32 {
        self.tag >> 2
    }
}

/// Largest number of diffuse particles from one fluid particle in one update.
const MOST_BORN: f32 = 64.0;

impl FoamParams {
    /// The kind of a particle with a number of neighbours in the fluid.
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

    /// Expected number of diffuse particles from a fluid particle with these potentials in `dt`
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

/// A pseudo-random number in [0, 1), bit-identical on all devices: 24 bits are exact in a float.
pub(super) fn unit(i: u32) -> f32 {
    (hash(i) >> 8) as f32 * (1.0 / 16_777_216.0)
}

/// The seed of the random numbers of a fluid particle in an update.
pub(super) fn seed_of(id: u32, step: u32) -> u32 {
    hash(id ^ hash(step))
}

/// The slot of candidate m if a fraction [`FoamState::share`] of the candidates is accepted:
/// floor(k f / 4096), without overflow, where f are the lower bits of the share and k = m / 2^s.
/// The slots of consecutive candidates differ by at most one; of several candidates with one slot,
/// the last is accepted.
pub(super) fn place_of(m: u32, share: u32) -> u32 {
    let (k, part) = (m >> (share >> 16), share & 0xffff);
    (k >> 12) * part + (((k & 4095) * part) >> 12)
}
