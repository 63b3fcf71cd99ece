//! A trefoil knot, a sphere and a rounded cube.

use std::collections::HashMap;
use std::f32::consts::TAU;

use glam::{Vec3, vec3};
use splashdown_io::Mesh;

use super::polygonise::polygonise;
use super::shape::cuboid;

/// The trefoil knot.
pub(super) fn torus_knot() -> Mesh {
    const ALONG: u32 = 420;
    const AROUND: u32 = 32;
    let rope = 0.046;
    let path = |t: f32| {
        let ((s1, c1), (s2, c2)) = (t.sin_cos(), (2.0 * t).sin_cos());
        0.09 * vec3(s1 + 2.0 * s2, c1 - 2.0 * c2, -(3.0 * t).sin())
    };
    let mut mesh = Mesh::default();
    for i in 0..ALONG {
        let t = TAU * i as f32 / ALONG as f32;
        let tangent = (path(t + 1e-3) - path(t - 1e-3)).normalize_or_zero();
        // The knot is nowhere parallel to z, so z defines a continuous frame along the closed curve.
        let u = Vec3::Z.reject_from_normalized(tangent).normalize_or_zero();
        let v = tangent.cross(u);
        for j in 0..AROUND {
            let (sin, cos) = (TAU * j as f32 / AROUND as f32).sin_cos();
            let normal = cos * u + sin * v;
            mesh.vertices.push((path(t) + rope * normal).to_array());
            mesh.normals.push(normal.to_array());
            let at = |i: u32, j: u32| i % ALONG * AROUND + j % AROUND;
            let (a, b, c, d) = (at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
            mesh.triangles.extend([[a, c, b], [a, d, c]]);
        }
    }
    mesh
}

/// An icosahedron whose triangles are split into four, five times.
pub(super) fn sphere() -> Mesh {
    let golden = 0.5 * (1.0 + 5.0_f32.sqrt());
    let mut points: Vec<Vec3> = Vec::new();
    for (a, b) in [(-1.0, golden), (1.0, golden), (-1.0, -golden), (1.0, -golden)] {
        points.extend([vec3(a, b, 0.0), vec3(0.0, a, b), vec3(b, 0.0, a)]);
    }
    // An icosahedron's triangles are the triples of corners two apart, counter-clockwise from outside.
    let near = |a: usize, b: usize| (points[a].distance(points[b]) - 2.0).abs() < 1e-3;
    let mut triangles: Vec<[u32; 3]> = Vec::new();
    for a in 0..12 {
        for b in a + 1..12 {
            for c in b + 1..12 {
                if near(a, b) && near(b, c) && near(a, c) {
                    let outwards = points[a].dot(points[b].cross(points[c])) > 0.0;
                    let corners = if outwards { [a, b, c] } else { [a, c, b] };
                    triangles.push(corners.map(|corner| corner as u32));
                }
            }
        }
    }
    for _ in 0..5 {
        let mut middles: HashMap<[u32; 2], u32> = HashMap::new();
        let mut split = Vec::with_capacity(4 * triangles.len());
        for &[a, b, c] in &triangles {
            let [ab, bc, ca] = [[a, b], [b, c], [c, a]].map(|[p, q]| {
                *middles.entry([p.min(q), p.max(q)]).or_insert_with(|| {
                    points.push(
                        (points[p as usize] + points[q as usize]).normalize_or_zero() * points[0].length(),
                    );
                    points.len() as u32 - 1
                })
            });
            split.extend([[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]);
        }
        triangles = split;
    }
    let normals: Vec<Vec3> = points.iter().map(|p| p.normalize_or_zero()).collect();
    Mesh::new(normals.iter().map(|n| (0.1 * n).to_array()).collect(), triangles)
        .with_normals(normals.iter().map(Vec3::to_array).collect())
}

pub(super) fn block() -> Mesh {
    polygonise(Vec3::splat(-0.115), Vec3::splat(0.115), 0.005, |p| cuboid(p, Vec3::splat(0.1), 0.012))
}
