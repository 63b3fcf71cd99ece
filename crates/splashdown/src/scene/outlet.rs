//! The geometry of outlets: their axes and the lattices of their layers.

use glam::{Vec2, Vec3};

/// Two unit vectors perpendicular to a direction: a horizontal one (x for a vertical direction), and their
/// cross product.
pub fn axes(direction: Vec3) -> (Vec3, Vec3) {
    let across = Vec3::Y.cross(direction);
    let across = if across.length_squared() < 1e-6 { Vec3::X } else { across.normalize_or_zero() };
    (across, direction.cross(across))
}

/// A layer of particles in a disc: points in m along [`axes`], on a square lattice that ends half a spacing
/// inside the rim. The lattice has either a point or the centre of a square at the disc's centre, whichever
/// represents the disc's area better.
pub fn disc_layer(radius: f32, spacing: f32) -> Vec<Vec2> {
    let reach = (radius / spacing).ceil() as i32 + 1;
    let area = std::f32::consts::PI * radius * radius / (spacing * spacing);
    let inside = |q: &Vec2| q.length() <= radius - 0.499 * spacing;
    let layers = [0.0, 0.5].map(|shift| {
        let points = (-reach..=reach).flat_map(|j| (-reach..=reach).map(move |i| (i, j)));
        let place = |(i, j): (i32, i32)| spacing * (Vec2::new(i as f32, j as f32) + shift);
        points.map(place).filter(inside).collect::<Vec<_>>()
    });
    let best = layers.into_iter().filter(|layer| !layer.is_empty());
    best.min_by(|a, b| (a.len() as f32 - area).abs().total_cmp(&(b.len() as f32 - area).abs()))
        .unwrap_or_else(|| vec![Vec2::ZERO])
}

/// As [`disc_layer`], for a rectangle of this size in m. The edges are rounded to multiples of the spacing.
pub fn rectangle_layer(size: [f32; 2], spacing: f32) -> Vec<Vec2> {
    let [n, m] = size.map(|edge| ((edge / spacing).round() as i32).max(1));
    let place = |i: i32, n: i32| spacing * (i as f32 - 0.5 * (n - 1) as f32);
    (0..m).flat_map(|j| (0..n).map(move |i| Vec2::new(place(i, n), place(j, m)))).collect()
}
