//! The positions and numbers of the particles of blocks.

use glam::Vec3;

use super::types::{Domain, Fluid, Shape};

/// Maximum number of particles of a scene: 2^26.
pub const MAX_PARTICLES: u64 = 1 << 26;

/// A block's face touches a wall if it is no further from it than this, in spacings. It covers the rounding
/// of positions to f32.
const TOUCH: f64 = 0.02;
/// Particles no further than this from an earlier block, in spacings, are left out. The block's particles lie
/// half a spacing inside its faces, so at least three quarters of a spacing remain between the particles.
const MARGIN: f64 = 0.25;

/// Two boxes that touch share a lattice if their lattices are no further apart than this along the faces that touch, in
/// spacings.
const ALIGNED: f64 = 0.25;

/// The largest logarithm of the distance of layers over the spacing. At this one the kernel sums of a lattice differ by less than
/// 1 % from those of a cubic one.
const MOST_DISTORTION: f64 = 0.1;

/// The thinnest part of a block that is packed by itself, in layers: images of images are left out.
const THINNEST: f64 = 6.0;

/// A block's shape in f64.
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

    /// Whether two boxes are less than `reach` apart.
    fn touches(&self, other: &Self, reach: f64) -> bool {
        let (Self::Box { min: low, max: high }, Self::Box { min: from, max: to }) = (self, other) else {
            return false;
        };
        (0..3).all(|a| low[a] - to[a] < reach && from[a] - high[a] < reach)
    }

    /// Whether a point is inside, or no further than `margin` outside.
    fn contains(&self, point: [f64; 3], margin: f64) -> bool {
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

/// The number of particles of a shape, estimated from its volume.
fn estimate_of(shape: &Shape, spacing: f64) -> f64 {
    let cells = |length: f32| (f64::from(length) / spacing).max(0.0);
    match *shape {
        Shape::Box { size, .. } => size.to_array().map(|length| cells(length).round()).into_iter().product(),
        Shape::Sphere { radius, .. } => cells(radius).powi(3) * (4.0 / 3.0 * std::f64::consts::PI),
    }
}

/// The number of particles of a fluid's blocks: exact up to [`MAX_PARTICLES`], an estimate above.
pub(crate) fn count(domain: &Domain, fluid: &Fluid) -> u64 {
    let estimate = estimate(fluid);
    if estimate > MAX_PARTICLES {
        return estimate;
    }
    Sampler::all(domain, fluid).iter().map(|sampler| sampler.counts().0).sum()
}

/// The number of particles estimated from the blocks' volumes. Overlaps are counted twice.
pub(crate) fn estimate(fluid: &Fluid) -> u64 {
    let spacing = f64::from(fluid.particle_spacing);
    // `as` saturates, and makes a NaN 0.
    fluid.blocks.iter().map(|block| estimate_of(&block.shape, spacing)).sum::<f64>() as u64
}

/// The spacing, rounded up to two digits, at which `count` particles become at most `allowed`.
pub(crate) fn fitting_spacing(spacing: f32, count: u64, allowed: u64) -> f32 {
    let exact = f64::from(spacing) * (count as f64 / allowed.max(1) as f64).cbrt();
    let unit = 10f64.powf(exact.log10().floor() - 1.0);
    ((exact / unit * 1.001).ceil() * unit) as f32
}

/// Creates the particles of one block.
#[derive(Debug)]
pub(crate) struct Sampler {
    solid: Solid,
    first: [f64; 3],
    counts: [u64; 3],
    /// Distances of the layers along each axis in m.
    pitches: [f64; 3],
    spacing: f64,
    /// Earlier blocks that may overlap this one.
    earlier: Vec<Solid>,
    /// See [`particle_bounds`].
    bounds: ([f64; 3], [f64; 3]),
}

impl Sampler {
    /// One sampler for each block of the fluid.
    pub fn all(domain: &Domain, fluid: &Fluid) -> Vec<Self> {
        let spacing = f64::from(fluid.particle_spacing);
        let solids: Vec<Solid> = fluid.blocks.iter().map(|block| Solid::new(&block.shape)).collect();
        let mut samplers: Vec<Self> = Vec::with_capacity(solids.len());
        for index in 0..solids.len() {
            let (solid, before) = (solids[index], &solids[..index]);
            let touching = samplers.iter().find(|earlier| solid.touches(&earlier.solid, spacing));
            let pitches = pitches_of(domain, spacing, &solid, touching);
            let mut sampler = Self::new(domain, spacing, pitches, solid, before);
            if let Some(earlier) = touching {
                sampler.first = sampler.joined(earlier, domain);
            }
            samplers.push(sampler);
        }
        samplers
    }

    /// The first point of this box's lattice, moved onto the lattice of an earlier box that it touches. Across the faces
    /// that touch, it moves by at most half a spacing, and otherwise by at most a quarter. It does not move away from a
    /// wall that it touches, nor along an axis on which the layers of the two boxes are not equally far apart.
    fn joined(&self, earlier: &Self, domain: &Domain) -> [f64; 3] {
        let ((low, high), (from, to)) = (self.solid.bounds(), earlier.solid.bounds());
        let mut first = self.first;
        for a in 0..3 {
            let pitch = self.pitches[a];
            let is_fixed = touches(domain, self.spacing, a, low[a], high[a]).contains(&true);
            let is_parallel = (pitch - earlier.pitches[a]).abs() * self.counts[a] as f64 <= TOUCH * pitch;
            let gap = (low[a] - to[a]).max(from[a] - high[a]);
            let tolerance = if gap > -self.spacing { 0.5 } else { ALIGNED };
            let apart = (self.first[a] - earlier.first[a]) / pitch;
            let shift = apart.round() - apart;
            let moved = self.first[a] + shift * pitch;
            let last = moved + self.counts[a].saturating_sub(1) as f64 * pitch;
            let fits = moved >= self.bounds.0[a] && last <= self.bounds.1[a];
            if !is_fixed && is_parallel && fits && shift.abs() <= tolerance {
                first[a] = moved;
            }
        }
        first
    }

    fn new(domain: &Domain, spacing: f64, pitches: [f64; 3], solid: Solid, before: &[Solid]) -> Self {
        let (low, high) = solid.bounds();
        let along = |axis: usize| match &solid {
            Solid::Box { .. } => along_box(domain, spacing, pitches[axis], axis, low[axis], high[axis]),
            Solid::Sphere { .. } => {
                let half = (0.5 * (high[axis] - low[axis]) / spacing).ceil();
                let center = 0.5 * (low[axis] + high[axis]);
                (center + (0.5 - half) * spacing, (half * 2.0) as u64)
            }
        };
        let axes: [(f64, u64); 3] = std::array::from_fn(along);
        let near = |other: &&Solid| {
            let (other_low, other_high) = other.bounds();
            let reach = MARGIN * spacing;
            (0..3).all(|a| other_low[a] - reach < high[a] && other_high[a] + reach > low[a])
        };
        Self {
            solid,
            first: axes.map(|(first, _)| first),
            counts: axes.map(|(_, count)| count),
            pitches,
            spacing,
            earlier: before.iter().filter(near).copied().collect(),
            bounds: particle_bounds(domain, spacing),
        }
    }

    /// Calls `visit(position, free)` for each particle, x fastest; `free` is false inside an earlier block.
    pub fn for_each(&self, mut visit: impl FnMut([f64; 3], bool)) {
        let at = |axis: usize, index: u64| self.first[axis] + index as f64 * self.pitches[axis];
        for k in 0..self.counts[2] {
            for j in 0..self.counts[1] {
                for i in 0..self.counts[0] {
                    let point = [at(0, i), at(1, j), at(2, k)];
                    if self.is_filled(point) {
                        let overlaps = |solid: &Solid| solid.contains(point, MARGIN * self.spacing);
                        visit(point, !self.earlier.iter().any(overlaps));
                    }
                }
            }
        }
    }

    /// The volume of the particles over that of the box before parts that overlap earlier blocks are left out; `None` for a
    /// ball.
    pub fn volume_ratio(&self) -> Option<f64> {
        let Solid::Box { min, max } = &self.solid else { return None };
        let volume: f64 = (0..3).map(|a| (max[a] - min[a]) / self.spacing).product();
        Some(self.counts.into_iter().map(|count| count as f64).product::<f64>() / volume)
    }

    /// Numbers of layers along each axis.
    pub fn layers(&self) -> [u64; 3] {
        self.counts
    }

    /// The corners of the smallest box of whole cells of the lattice that contains the common part of this box and of each of
    /// `boxes`, at least [`THINNEST`] cells along each axis; `None` if there is no common part, or for a ball.
    pub fn part_within(&self, boxes: &[(Vec3, Vec3)]) -> Option<(Vec3, Vec3)> {
        let Solid::Box { .. } = self.solid else { return None };
        let low: [f64; 3] = std::array::from_fn(|a| self.first[a] - 0.5 * self.pitches[a]);
        let cell = |a: usize, x: f32| (f64::from(x) - low[a]) / self.pitches[a];
        let mut range: [[f64; 2]; 3] = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
        for (from, to) in boxes {
            let ends: [[f64; 2]; 3] = std::array::from_fn(|a| {
                [cell(a, from[a]).max(0.0), cell(a, to[a]).min(self.counts[a] as f64)]
            });
            if ends.iter().all(|[from, to]| from < to) {
                range = std::array::from_fn(|a| [range[a][0].min(ends[a][0]), range[a][1].max(ends[a][1])]);
            }
        }
        if range.iter().any(|[from, to]| from >= to) {
            return None;
        }
        let ends: [[f32; 2]; 3] = std::array::from_fn(|a| {
            let count = self.counts[a] as f64;
            let [from, to] = [range[a][0].floor(), range[a][1].ceil()];
            let missing = (THINNEST - (to - from)).max(0.0);
            let from = (from - missing).max(0.0);
            [from, to.max(from + THINNEST).min(count)].map(|index| (low[a] + index * self.pitches[a]) as f32)
        });
        Some((ends.map(|end| end[0]).into(), ends.map(|end| end[1]).into()))
    }

    /// The number of particles created, and the number left out because they overlap an earlier block.
    pub fn counts(&self) -> (u64, u64) {
        if let (Solid::Box { .. }, true) = (&self.solid, self.earlier.is_empty()) {
            return (self.counts.into_iter().fold(1, u64::saturating_mul), 0);
        }
        let (mut created, mut left_out) = (0, 0);
        self.for_each(|_, free| if free { created += 1 } else { left_out += 1 });
        (created, left_out)
    }

    /// Whether a lattice point lies in the shape. All points of a box do. The points of a ball that are
    /// nearer than half a spacing to a wall are left out.
    fn is_filled(&self, point: [f64; 3]) -> bool {
        match &self.solid {
            Solid::Box { .. } => true,
            ball => {
                let (min, max) = self.bounds;
                (0..3).all(|a| point[a] >= min[a] && point[a] <= max[a]) && ball.contains(point, 0.0)
            }
        }
    }
}

/// Whether a box from `low` to `high` (m) touches the lower and the upper closed side of an axis.
fn touches(domain: &Domain, spacing: f64, axis: usize, low: f64, high: f64) -> [bool; 2] {
    let place = [domain.min[axis], domain.max[axis]].map(f64::from);
    let is_near = |face: f64, wall: f64| (face - wall).abs() <= TOUCH * spacing;
    let [low_closed, high_closed] = domain.closed[axis];
    [low_closed && is_near(low, place[0]), high_closed && is_near(high, place[1])]
}

/// The distances of the layers of particles of a block along each axis in m.
///
/// A box between two walls may be no multiple of the spacing wide. Its layers are then farther apart or closer than a
/// spacing, so that they fill it without gaps at the walls, and those along the other axes the reverse, so that each
/// particle keeps its volume. A box between no two walls continues the lattice of an earlier box that it touches.
fn pitches_of(domain: &Domain, spacing: f64, solid: &Solid, touching: Option<&Sampler>) -> [f64; 3] {
    let Solid::Box { min, max } = solid else { return [spacing; 3] };
    let lengths: [f64; 3] = std::array::from_fn(|a| (max[a] - min[a]) / spacing);
    let spans: [bool; 3] =
        std::array::from_fn(|a| touches(domain, spacing, a, min[a], max[a]) == [true, true]);
    let most = spans.iter().filter(|&&spans| spans).count();
    match touching {
        Some(earlier) if most == 0 => return earlier.pitches,
        _ if (0..3).all(|a| !spans[a] || (lengths[a] - lengths[a].round()).abs() <= TOUCH) => {
            return [spacing; 3];
        }
        _ => {}
    }
    // Each number of layers is rounded down or up.
    let counts = |axis: usize| {
        if spans[axis] {
            vec![(lengths[axis] + TOUCH).floor(), (lengths[axis] - TOUCH).ceil()]
        } else {
            vec![1.0]
        }
    };
    let mut best = [spacing; 3];
    let mut least = f64::INFINITY;
    for x in counts(0) {
        for y in counts(1) {
            for z in counts(2) {
                let stretch: [f64; 3] =
                    std::array::from_fn(|a| if spans[a] { lengths[a] / [x, y, z][a] } else { 1.0 });
                let volume: f64 = stretch.iter().product();
                // Nothing compensates for fluid that is compressed between walls on all sides.
                let is_compressed = most == 3 && volume < 1.0;
                let distortion =
                    stretch.iter().map(|stretch| stretch.ln().abs()).fold(volume.ln().abs(), f64::max);
                if distortion < least && distortion <= MOST_DISTORTION && !is_compressed {
                    least = distortion;
                    let others = if most < 3 { volume.powf(-1.0 / (3 - most) as f64) } else { 1.0 };
                    best = std::array::from_fn(|a| spacing * if spans[a] { stretch[a] } else { others });
                }
            }
        }
    }
    best
}

/// The first coordinate (m) and the number of the particles of a box along an axis, whose layers are `pitch` (m) apart. They
/// start half a pitch from a wall that the box touches; otherwise they are centred in the box.
fn along_box(domain: &Domain, spacing: f64, pitch: f64, axis: usize, low: f64, high: f64) -> (f64, u64) {
    let length = (high - low) / pitch;
    let (count, start) = match touches(domain, spacing, axis, low, high) {
        // Rounding up would compress the fluid between two walls.
        [true, true] => centred((length + TOUCH).floor(), length, pitch),
        [true, false] => (length.round(), 0.5 * pitch),
        [false, true] => (length.round(), (length - length.round() + 0.5) * pitch),
        [false, false] => centred(length.round(), length, pitch),
    };
    (low + start, count as u64)
}

/// [`along_box`] along all axes, for layers a spacing apart.
pub(crate) fn axes(domain: &Domain, spacing: f64, low: Vec3, high: Vec3) -> [(f64, u64); 3] {
    std::array::from_fn(|a| along_box(domain, spacing, spacing, a, f64::from(low[a]), f64::from(high[a])))
}

/// The corners in m of the box in which particles may lie: half a spacing inside closed sides, unbounded at
/// open sides.
pub(crate) fn particle_bounds(domain: &Domain, spacing: f64) -> ([f64; 3], [f64; 3]) {
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

/// `count` layers centred in a length given in pitches (m): their number, and the offset in m of the first one.
fn centred(count: f64, length: f64, pitch: f64) -> (f64, f64) {
    (count, (length - count + 1.0) * 0.5 * pitch)
}
