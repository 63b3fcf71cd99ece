//! The lattices of blocks: where their particles are, and how many there are.

use glam::Vec3;

use super::types::{Domain, Fluid, Shape};

/// Most particles of a scene: 2^26.
pub const MAX_PARTICLES: u64 = 1 << 26;

/// How near a block's face must be to a wall to touch it, in spacings: positions in f32 are not exact.
const TOUCH: f64 = 0.02;
/// A particle this near to an earlier block, in spacings, would be pressed against that block's particles.
/// Those stand half a spacing inside, so three quarters of a spacing is the smallest distance that remains.
const CROWDED: f64 = 0.25;

/// A shape in f64.
#[derive(Debug, Clone, Copy)]
enum Solid {
    Box { min: [f64; 3], max: [f64; 3] },
    Sphere { center: [f64; 3], radius: f64 },
}

impl Solid {
    fn new(shape: &Shape) -> Self {
        match *shape {
            Shape::Box { min, size } => {
                let min = min.to_array().map(f64::from);
                Self::Box { min, max: std::array::from_fn(|a| min[a] + f64::from(size[a])) }
            }
            Shape::Sphere { center, radius } => {
                Self::Sphere { center: center.to_array().map(f64::from), radius: f64::from(radius) }
            }
        }
    }

    fn bounds(&self) -> ([f64; 3], [f64; 3]) {
        match *self {
            Self::Box { min, max } => (min, max),
            Self::Sphere { center, radius } => (center.map(|x| x - radius), center.map(|x| x + radius)),
        }
    }

    /// Whether a point is inside, or no further than `margin` outside.
    fn holds(&self, point: [f64; 3], margin: f64) -> bool {
        match self {
            Self::Box { min, max } => {
                (0..3).all(|a| point[a] > min[a] - margin && point[a] < max[a] + margin)
            }
            Self::Sphere { center, radius } => {
                let squared: f64 = (0..3).map(|a| (point[a] - center[a]).powi(2)).sum();
                squared <= (radius + margin).powi(2)
            }
        }
    }
}

/// Particles of a shape by its volume.
fn estimate_of(shape: &Shape, spacing: f64) -> f64 {
    let cells = |length: f32| (f64::from(length) / spacing).max(0.0);
    match *shape {
        Shape::Box { size, .. } => size.to_array().map(|length| cells(length).round()).into_iter().product(),
        Shape::Sphere { radius, .. } => cells(radius).powi(3) * (4.0 / 3.0 * std::f64::consts::PI),
    }
}

/// Particles of the blocks of a fluid: exact up to [`MAX_PARTICLES`], above that an estimate.
pub(crate) fn count(domain: &Domain, fluid: &Fluid) -> u64 {
    let estimate = estimate(fluid);
    if estimate > MAX_PARTICLES {
        return estimate;
    }
    Sampler::all(domain, fluid).iter().map(|sampler| sampler.counts().0).sum()
}

/// Particles from the blocks' volumes, overlaps counted twice.
pub(crate) fn estimate(fluid: &Fluid) -> u64 {
    let spacing = f64::from(fluid.particle_spacing);
    // `as` saturates, and makes a NaN 0.
    fluid.blocks.iter().map(|block| estimate_of(&block.shape, spacing)).sum::<f64>() as u64
}

/// A spacing at which `count` particles become no more than `allowed`, rounded up to two digits.
pub(crate) fn fitting_spacing(spacing: f32, count: u64, allowed: u64) -> f32 {
    let exact = f64::from(spacing) * (count as f64 / allowed.max(1) as f64).cbrt();
    let unit = 10f64.powf(exact.log10().floor() - 1.0);
    ((exact / unit * 1.001).ceil() * unit) as f32
}

/// Makes the particles of one block.
#[derive(Debug)]
pub(crate) struct Sampler {
    solid: Solid,
    first: [f64; 3],
    counts: [u64; 3],
    spacing: f64,
    /// Earlier blocks that may overlap this one.
    earlier: Vec<Solid>,
    /// Half a spacing inside the closed walls, without limit at open sides.
    room: ([f64; 3], [f64; 3]),
}

impl Sampler {
    /// One for each block of the fluid.
    pub fn all(domain: &Domain, fluid: &Fluid) -> Vec<Self> {
        let spacing = f64::from(fluid.particle_spacing);
        let solids: Vec<Solid> = fluid.blocks.iter().map(|block| Solid::new(&block.shape)).collect();
        (0..solids.len()).map(|index| Self::new(domain, spacing, &solids[..=index])).collect()
    }

    fn new(domain: &Domain, spacing: f64, solids: &[Solid]) -> Self {
        let (solid, before) = (solids[solids.len() - 1], &solids[..solids.len() - 1]);
        let (low, high) = solid.bounds();
        let along = |axis: usize| match &solid {
            Solid::Box { .. } => along_box(domain, spacing, axis, low[axis], high[axis]),
            Solid::Sphere { .. } => {
                let half = (0.5 * (high[axis] - low[axis]) / spacing).ceil();
                let center = 0.5 * (low[axis] + high[axis]);
                (center + (0.5 - half) * spacing, (half * 2.0) as u64)
            }
        };
        let axes: [(f64, u64); 3] = std::array::from_fn(along);
        let near = |other: &&Solid| {
            let (other_low, other_high) = other.bounds();
            let reach = CROWDED * spacing;
            (0..3).all(|a| other_low[a] - reach < high[a] && other_high[a] + reach > low[a])
        };
        Self {
            solid,
            first: axes.map(|(first, _)| first),
            counts: axes.map(|(_, count)| count),
            spacing,
            earlier: before.iter().filter(near).copied().collect(),
            room: room(domain, spacing),
        }
    }

    /// Calls `visit(position, free)` for each particle, x fastest; `free` is false where an earlier block already is.
    pub fn for_each(&self, mut visit: impl FnMut([f64; 3], bool)) {
        let at = |axis: usize, index: u64| self.first[axis] + index as f64 * self.spacing;
        for k in 0..self.counts[2] {
            for j in 0..self.counts[1] {
                for i in 0..self.counts[0] {
                    let point = [at(0, i), at(1, j), at(2, k)];
                    if self.is_filled(point) {
                        let crowded = |solid: &Solid| solid.holds(point, CROWDED * self.spacing);
                        visit(point, !self.earlier.iter().any(crowded));
                    }
                }
            }
        }
    }

    /// How many particles it makes, and how many it leaves out because they overlap an earlier block.
    pub fn counts(&self) -> (u64, u64) {
        if let (Solid::Box { .. }, true) = (&self.solid, self.earlier.is_empty()) {
            return (self.counts.into_iter().fold(1, u64::saturating_mul), 0);
        }
        let (mut made, mut left_out) = (0, 0);
        self.for_each(|_, free| if free { made += 1 } else { left_out += 1 });
        (made, left_out)
    }

    /// A box is filled whole; a ball keeps away from walls, which it would otherwise touch with a few particles.
    fn is_filled(&self, point: [f64; 3]) -> bool {
        match &self.solid {
            Solid::Box { .. } => true,
            ball => {
                let in_room = (0..3).all(|a| point[a] >= self.room.0[a] && point[a] <= self.room.1[a]);
                in_room && ball.holds(point, 0.0)
            }
        }
    }
}

/// First coordinate (m) and number of the particles of a box along an axis: on the walls that it touches, else
/// in its middle.
fn along_box(domain: &Domain, spacing: f64, axis: usize, low: f64, high: f64) -> (f64, u64) {
    let length = (high - low) / spacing;
    let closed = domain.closed[axis];
    let place = [domain.min[axis], domain.max[axis]].map(f64::from);
    let touches_low = closed[0] && (low - place[0]).abs() <= TOUCH * spacing;
    let touches_high = closed[1] && (place[1] - high).abs() <= TOUCH * spacing;
    let (count, start) = match (touches_low, touches_high) {
        // From wall to wall nothing may be squeezed in.
        (true, true) => centred((length + TOUCH).floor(), length, spacing),
        (true, false) => (length.round(), 0.5 * spacing),
        (false, true) => (length.round(), (length - length.round() + 0.5) * spacing),
        (false, false) => centred(length.round(), length, spacing),
    };
    (low + start, count as u64)
}

/// [`along_box`] along all axes.
pub(crate) fn axes(domain: &Domain, spacing: f64, low: Vec3, high: Vec3) -> [(f64, u64); 3] {
    std::array::from_fn(|a| along_box(domain, spacing, a, f64::from(low[a]), f64::from(high[a])))
}

/// Corners in m of where particles may be: half a spacing inside the closed walls, without limit at open sides.
pub(crate) fn room(domain: &Domain, spacing: f64) -> ([f64; 3], [f64; 3]) {
    let low = |axis: usize| match domain.closed[axis][0] {
        true => f64::from(domain.min[axis]) + (0.5 - TOUCH) * spacing,
        false => f64::NEG_INFINITY,
    };
    let high = |axis: usize| match domain.closed[axis][1] {
        true => f64::from(domain.max[axis]) - (0.5 - TOUCH) * spacing,
        false => f64::INFINITY,
    };
    (std::array::from_fn(low), std::array::from_fn(high))
}

/// `count` particles in the middle of a length given in spacings.
fn centred(count: f64, length: f64, spacing: f64) -> (f64, f64) {
    (count, (length - count + 1.0) * 0.5 * spacing)
}
