//! How thick solids are, and how narrow the gaps between them.
//!
//! Rays start at points that are spread evenly over a surface. The thickness at a point is the distance to the opposite
//! side along the inward normal (the shape diameter of Shapira et al. 2008, with a single ray), the gap the distance to
//! the next surface along the outward normal. A small part of the surface always lies next to edges, where both vanish;
//! therefore the narrowest twentieth decides.

use glam::Vec3;

use super::bvh::Bvh;

/// Rays per surface and direction.
const RAYS: usize = 4000;
/// The part of the surface that may be narrower than the reported width.
const PART: f32 = 0.05;

/// The triangles of a surface.
pub(crate) type Triangles = Vec<[Vec3; 3]>;

/// The widths of a surface, in m. `None` if they exceed the longest ray.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Widths {
    /// A twentieth of the surface belongs to parts that are at most this thick.
    pub thickness: Option<f32>,
    /// A twentieth of the surface is at most this far from the surface in front of it, another one, its own, or a plane.
    pub gap: Option<f32>,
}

/// The widths of surfaces in a common frame, up to `most`. `low` and `high` are the corners of the box, infinite where a
/// side is open. Distances below `touching` are contacts and not gaps.
pub(crate) fn widths(surfaces: &[Triangles], low: Vec3, high: Vec3, touching: f32, most: f32) -> Vec<Widths> {
    let trees: Vec<Option<Bvh>> =
        surfaces.iter().map(|own| (!own.is_empty()).then(|| Bvh::new(own.clone()))).collect();
    let of = |own: usize| {
        let Some(tree) = &trees[own] else { return Widths::default() };
        let points = points(&surfaces[own]);
        // Rays start a little beside the surface, which must not hide what is behind it.
        let aside = 1e-4 * most;
        let thicknesses = points.iter().map(|(x, normal)| {
            tree.ray(*x - aside * *normal, -*normal, most, true).map(|width| width + aside)
        });
        let gaps = points.iter().map(|(x, normal)| {
            let start = *x + aside * *normal;
            let solids = trees.iter().flatten().filter_map(|tree| tree.ray(start, *normal, most, false));
            let gap = solids.fold(to_side(start, *normal, low, high), f32::min) + aside;
            (gap > touching && gap < most).then_some(gap)
        });
        Widths { thickness: narrow(thicknesses), gap: narrow(gaps) }
    };
    (0..surfaces.len()).map(of).collect()
}

/// The width that a [`PART`] of the rays do not exceed. Rays without a hit are wider.
fn narrow(rays: impl Iterator<Item = Option<f32>>) -> Option<f32> {
    let mut widths: Vec<f32> = rays.map(|width| width.unwrap_or(f32::INFINITY)).collect();
    if widths.is_empty() {
        return None;
    }
    let place = ((PART * widths.len() as f32) as usize).min(widths.len() - 1);
    let (_, width, _) = widths.select_nth_unstable_by(place, f32::total_cmp);
    width.is_finite().then_some(*width)
}

/// The distance along a ray to the sides of a box that contains its origin.
fn to_side(origin: Vec3, direction: Vec3, low: Vec3, high: Vec3) -> f32 {
    let mut nearest = f32::INFINITY;
    for axis in 0..3 {
        let side = if direction[axis] > 0.0 { high[axis] } else { low[axis] };
        // Sides that the ray approaches at a grazing angle are not in front of the surface.
        if direction[axis].abs() > 0.5 {
            nearest = nearest.min(((side - origin[axis]) / direction[axis]).max(0.0));
        }
    }
    nearest
}

/// Points of a surface with its normals, evenly spread.
fn points(triangles: &[[Vec3; 3]]) -> Vec<(Vec3, Vec3)> {
    let cross = |t: &[Vec3; 3]| (t[1] - t[0]).cross(t[2] - t[0]);
    let total: f32 = triangles.iter().map(|t| cross(t).length()).sum();
    let mut points = Vec::with_capacity(RAYS);
    let mut pending = 0.0;
    for t in triangles {
        pending += RAYS as f32 * cross(t).length() / total.max(f32::MIN_POSITIVE);
        while pending >= 1.0 {
            pending -= 1.0;
            // The R2 sequence (Roberts 2018) folded into the triangle.
            let k = points.len() as f64;
            let (mut u, mut v) = ((0.754_877_7 * k).fract() as f32, (0.569_840_3 * k).fract() as f32);
            if u + v > 1.0 {
                (u, v) = (1.0 - u, 1.0 - v);
            }
            let x = t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]);
            points.push((x, cross(t).normalize_or_zero()));
        }
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    fn block(low: Vec3, high: Vec3) -> Triangles {
        let mesh = crate::models::build("cube").unwrap();
        let place = |v: u32| low + (Vec3::from(mesh.vertices[v as usize]) + 0.5) * (high - low);
        mesh.triangles.iter().map(|t| t.map(place)).collect()
    }

    const OPEN: (Vec3, Vec3) = (Vec3::NEG_INFINITY, Vec3::INFINITY);

    #[test]
    fn the_thickness_of_a_plate_is_its_shortest_edge() {
        let plate = block(Vec3::ZERO, Vec3::new(1.0, 0.03, 0.8));
        let found = widths(&[plate], OPEN.0, OPEN.1, 0.001, 10.0)[0];
        assert!((found.thickness.unwrap() - 0.03).abs() < 1e-3, "{found:?}");
        // Control: nothing is in front of a plate in open space.
        assert_eq!(found.gap, None);
    }

    #[test]
    fn gaps_are_measured_to_other_surfaces_and_to_closed_sides() {
        let lower = block(Vec3::new(0.0, 0.2, 0.0), Vec3::new(1.0, 0.5, 1.0));
        let upper = block(Vec3::new(0.0, 0.6, 0.0), Vec3::new(1.0, 1.0, 1.0));
        let low = Vec3::new(f32::NEG_INFINITY, 0.15, f32::NEG_INFINITY);
        let found = widths(&[lower, upper], low, OPEN.1, 0.001, 10.0);
        assert!((found[0].gap.unwrap() - 0.05).abs() < 1e-2, "{found:?}");
        assert!((found[1].gap.unwrap() - 0.1).abs() < 1e-2, "{found:?}");
        // Controls: a contact is not a gap, and a ray does not see beyond its length.
        assert_eq!(widths(&[block(Vec3::ZERO, Vec3::ONE)], Vec3::ZERO, OPEN.1, 0.01, 10.0)[0].gap, None);
        assert_eq!(widths(&[block(Vec3::ZERO, Vec3::ONE)], OPEN.0, OPEN.1, 0.01, 0.5)[0], Widths::default());
    }
}
