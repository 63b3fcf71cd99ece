//! Points on a surface and inside a solid.

use std::collections::HashMap;

use glam::{IVec3, Quat, Vec3};
use splashdown_io::Mesh;

use super::field::DistanceField;

/// Candidates per square of one spacing.
const CANDIDATES: f32 = 40.0;
/// Smallest distance between points, in spacings. With this value their mean distance is about one spacing.
const MIN_DISTANCE: f32 = 0.8;

/// Evenly distributed points of a surface. Candidates in a fixed sequence are accepted if no accepted point
/// is too near (dart throwing; Bridson 2007). Points are moved inwards by `depth` along the faces' normals.
/// Near edges, where such a point is less than `depth` inside, it is left out.
pub(super) fn surface(mesh: &Mesh, field: &DistanceField, spacing: f32, depth: f32) -> Vec<Vec3> {
    let corner = |v: u32| Vec3::from(mesh.vertices[v as usize]);
    let areas: Vec<f32> = mesh
        .triangles
        .iter()
        .map(|t| {
            let [a, b, c] = t.map(corner);
            0.5 * (b - a).cross(c - a).length()
        })
        .collect();
    let mut candidates = Vec::new();
    // Fractions of a candidate are carried over to the next triangle.
    let mut pending = 0.0;
    let mut k = 0u32;
    for (t, area) in mesh.triangles.iter().zip(&areas) {
        let [a, b, c] = t.map(corner);
        let inwards = -(b - a).cross(c - a).normalize_or_zero() * depth;
        pending += CANDIDATES * area / (spacing * spacing);
        while pending >= 1.0 {
            pending -= 1.0;
            // The R2 sequence (Roberts 2018) folded into the triangle.
            let (mut u, mut v) =
                ((0.754_877_7 * f64::from(k)).fract() as f32, (0.569_840_3 * f64::from(k)).fract() as f32);
            if u + v > 1.0 {
                (u, v) = (1.0 - u, 1.0 - v);
            }
            let x = a + u * (b - a) + v * (c - a) + inwards;
            if field.covers(x) && (depth <= 0.0 || field.distance(x) < -0.9 * depth) {
                candidates.push(x);
            }
            k += 1;
        }
    }
    // The candidates are visited with a large stride, so that the points do not depend on the order of the
    // triangles.
    let n = candidates.len();
    let stride = (0.618_034 * n as f64) as usize | 1;
    let stride = (stride..).find(|s| gcd(*s, n.max(1)) == 1).unwrap_or(1);
    let reach = MIN_DISTANCE * spacing;
    let mut cells: HashMap<IVec3, Vec<Vec3>> = HashMap::new();
    let mut kept = Vec::new();
    for i in 0..n {
        let x = candidates[i * stride % n];
        let cell = (x / reach).floor().as_ivec3();
        let too_near = (0..27).any(|k| {
            let neighbour = cell + IVec3::new(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
            cells
                .get(&neighbour)
                .is_some_and(|list| list.iter().any(|y| y.distance_squared(x) < reach * reach))
        });
        if !too_near {
            cells.entry(cell).or_default().push(x);
            kept.push(x);
        }
    }
    kept
}

fn gcd(a: usize, b: usize) -> usize {
    if b == 0 { a } else { gcd(b, a % b) }
}

/// The points of the lattice through `origin` that lie at least `clearance` inside a solid with this pose, x
/// fastest.
pub(super) fn fill(
    field: &DistanceField,
    bounds: (Vec3, Vec3),
    (position, rotation): (Vec3, Quat),
    spacing: f32,
    origin: Vec3,
    clearance: f32,
) -> Vec<[f32; 3]> {
    let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    for k in 0..8 {
        let pick = |axis: usize| if k >> axis & 1 == 0 { bounds.0[axis] } else { bounds.1[axis] };
        let x = position + rotation * Vec3::new(pick(0), pick(1), pick(2));
        (low, high) = (low.min(x), high.max(x));
    }
    let first = ((low - origin) / spacing).floor().as_ivec3();
    let last = ((high - origin) / spacing).ceil().as_ivec3();
    let mut points = Vec::new();
    for z in first.z..=last.z {
        for y in first.y..=last.y {
            for x in first.x..=last.x {
                let p = origin + IVec3::new(x, y, z).as_vec3() * spacing;
                if field.distance(rotation.conjugate() * (p - position)) <= -clearance {
                    points.push(p.to_array());
                }
            }
        }
    }
    points
}
