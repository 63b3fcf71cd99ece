//! The geometry of outlets: their axes and the lattices of their layers.

use std::f32::consts::PI;

use glam::{Vec2, Vec3};

/// Two unit vectors perpendicular to a direction: a horizontal one (x for a vertical direction), and their
/// cross product.
pub fn axes(direction: Vec3) -> (Vec3, Vec3) {
    let across = Vec3::Y.cross(direction);
    let across = if across.length_squared() < 1e-6 { Vec3::X } else { across.normalize_or_zero() };
    (across, direction.cross(across))
}

/// Positions of a lattice relative to the centre of an outlet, in spacings. The one whose points represent the area best
/// is used.
pub const LATTICE_SHIFTS: [Vec2; 4] =
    [Vec2::ZERO, Vec2::splat(0.5), Vec2::new(0.5, 0.0), Vec2::new(0.0, 0.5)];

/// The area per point of a layer over the square of the spacing. Outlets of less than about two spacings need more or
/// less; their flow is inexact, and `check` warns of it. Layers that are closer than 0.8 spacings would block each other.
const ADJUSTMENT: [f32; 2] = [0.7, 1.25];

/// The particles that an emitter creates at a time.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// Their positions in m along [`axes`].
    pub points: Vec<Vec2>,
    /// Their places in the lattice from which they come: whole numbers.
    pub columns: Vec<Vec2>,
    /// Distances in m between columns and between rows.
    pub pitch: Vec2,
    /// Distance in m between layers.
    pub interval: f32,
}

impl Layer {
    /// The layer of these points of a square lattice for a cross-section of `area` (m^2). The distances between columns and
    /// between layers are adjusted, within [`ADJUSTMENT`], so that the flow is exact and the density the rest density.
    pub fn covering(area: f32, points: Vec<Vec2>, spacing: f32) -> Self {
        let [least, most] = ADJUSTMENT;
        let share = (area / (points.len() as f32 * spacing * spacing)).clamp(least, most);
        let stretch = share.sqrt();
        Self {
            columns: points.iter().map(|q| (*q / spacing + 0.25).floor()).collect(),
            points: points.into_iter().map(|q| stretch * q).collect(),
            pitch: Vec2::splat(stretch * spacing),
            interval: spacing / share,
        }
    }

    /// The emitted volume over the one of a cross-section of `area` (m^2).
    pub fn share_of(&self, area: f32, spacing: f32) -> f32 {
        self.points.len() as f32 * spacing.powi(3) / (self.interval * area)
    }
}

/// The smallest distance of a particle from the rim of a disc, in spacings.
const RIM: f32 = 0.25;

/// The layer of a disc. The points of a square lattice within the radius represent it; of several lattices, which differ
/// in their position relative to the centre, the one with the best area is used. Points nearer to the rim than `RIM`
/// are moved towards the centre, because an outlet may touch a wall, and the others make room for them.
pub fn disc_layer(radius: f32, spacing: f32) -> Layer {
    let reach = (radius / spacing).ceil() as i32 + 1;
    let area = PI * radius * radius;
    let inside = |q: &Vec2| q.length() <= 1.0001 * radius;
    let layers = LATTICE_SHIFTS.map(|shift| {
        let points = (-reach..=reach).flat_map(|j| (-reach..=reach).map(move |i| (i, j)));
        let place = |(i, j): (i32, i32)| spacing * (Vec2::new(i as f32, j as f32) + shift);
        points.map(place).filter(inside).collect::<Vec<_>>()
    });
    let error = |layer: &Vec<Vec2>| (layer.len() as f32 * spacing * spacing - area).abs();
    let best = layers.into_iter().filter(|layer| !layer.is_empty());
    let points = best.min_by(|a, b| error(a).total_cmp(&error(b))).unwrap_or_else(|| vec![Vec2::ZERO]);
    let layer = Layer::covering(area, points, spacing);
    let widest = (radius - RIM * spacing).max(0.5 * radius);
    let mut points: Vec<Vec2> = layer.points.iter().map(|q| q.clamp_length_max(widest)).collect();
    make_room(&mut points, layer.pitch.x, widest);
    Layer { points, ..layer }
}

/// Moves points that are too dense apart, within `widest` (m) of the centre. At the rim of a disc the density of a pipe
/// full of layers was up to 13 % above that at rest, and its pressure threw particles out. It is at most 3.5 % now.
///
/// The density of columns is the sum of (1 - (r / 2)^2)^5 over the distances r, in `pitch`, over that of the square
/// lattice: nearly the integral of the kernel for a support of two spacings along the columns. The points follow
/// its gradient, weighted with the excess of both columns.
fn make_room(points: &mut [Vec2], pitch: f32, widest: f32) {
    const STEPS: usize = 100;
    const REACH: f32 = 2.0;
    const DEPTH: f32 = 6.0;
    let base = |square: f32| (1.0 - square / (REACH * REACH)).max(0.0);
    let lattice = (0..25).map(|k| Vec2::new((k % 5) as f32 - 2.0, (k / 5) as f32 - 2.0));
    let full: f32 = lattice.map(|q| base(q.length_squared()).powi(5)).sum();
    // Deeper points have the density of the lattice and stay; those within two supports of the others still count.
    let deepest = widest - DEPTH * pitch;
    let outer: Vec<usize> =
        (0..points.len()).filter(|&i| points[i].length() > deepest - 2.0 * REACH * pitch).collect();
    let is_fixed: Vec<bool> = outer.iter().map(|&i| points[i].length() <= deepest).collect();
    for _ in 0..STEPS {
        let present: Vec<Vec2> = outer.iter().map(|&i| points[i]).collect();
        let pairs = pairs_within(&present, REACH * pitch);
        let mut excess = vec![base(0.0) / full - 1.0; present.len()];
        for &[i, j] in &pairs {
            let share = base((present[i] - present[j]).length_squared() / (pitch * pitch)).powi(5) / full;
            excess[i] += share;
            excess[j] += share;
        }
        let mut moves = vec![Vec2::ZERO; present.len()];
        for &[i, j] in &pairs {
            let d = present[i] - present[j];
            let slope = 10.0 / (REACH * REACH) * base(d.length_squared() / (pitch * pitch)).powi(4) / full;
            let push = (excess[i].max(0.0) + excess[j].max(0.0)) * slope * d;
            moves[i] += push;
            moves[j] -= push;
        }
        for (k, &i) in outer.iter().enumerate().filter(|(k, _)| !is_fixed[*k]) {
            points[i] = (present[k] + moves[k]).clamp_length_max(widest);
        }
    }
}

/// The pairs of points nearer than `reach`, each once.
fn pairs_within(points: &[Vec2], reach: f32) -> Vec<[usize; 2]> {
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_unstable_by(|&i, &j| points[i].x.total_cmp(&points[j].x));
    let mut pairs = Vec::new();
    for (k, &i) in order.iter().enumerate() {
        let near = order[k + 1..].iter().take_while(|&&j| points[j].x - points[i].x < reach);
        let close = near.filter(|&&j| (points[j] - points[i]).length_squared() < reach * reach);
        pairs.extend(close.map(|&j| [i, j]));
    }
    pairs
}

/// As [`disc_layer`], for a rectangle of this size in m. Each edge has one of the two nearest whole numbers of particles:
/// with which the flow is exact, if any, and the lattice nearest to a square one.
pub fn rectangle_layer(size: [f32; 2], spacing: f32) -> Layer {
    let [across, up] = size.map(|edge| {
        let fewer = (edge / spacing).floor() as i32;
        [fewer.max(1), fewer + 1]
    });
    let [least, most] = ADJUSTMENT;
    let stretched = |counts: &[i32; 2]| [0, 1].map(|k| size[k] / (counts[k] as f32 * spacing));
    let error = |counts: &[i32; 2]| {
        let [a, b] = stretched(counts);
        let flow = (a * b / (a * b).clamp(least, most)).ln().abs();
        100.0 * flow + a.ln().abs() + b.ln().abs()
    };
    let pairs = [[across[0], up[0]], [across[0], up[1]], [across[1], up[0]], [across[1], up[1]]];
    let counts = pairs.into_iter().min_by(|a, b| error(a).total_cmp(&error(b))).unwrap_or([1, 1]);
    let [a, b] = stretched(&counts);
    let share = (a * b).clamp(least, most);
    let pitch = [a, b].map(|stretch| spacing * stretch.max(least));
    let place = |i: i32, k: usize| pitch[k] * (i as f32 - 0.5 * (counts[k] - 1) as f32);
    let places: Vec<[i32; 2]> = (0..counts[1]).flat_map(|j| (0..counts[0]).map(move |i| [i, j])).collect();
    let points = places.iter().map(|&[i, j]| Vec2::new(place(i, 0), place(j, 1))).collect();
    let columns = places.iter().map(|&[i, j]| Vec2::new(i as f32, j as f32)).collect();
    Layer { points, columns, pitch: pitch.into(), interval: spacing / share }
}
