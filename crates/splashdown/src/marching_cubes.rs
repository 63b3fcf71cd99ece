//! The marching-cubes table, generated from its rules.
//!
//! Corner `c` of a cube is at `(c & 1, c >> 1 & 1, c >> 2)`. Edge `e` is parallel to axis `e / 4`;
//! its two low bits are its coordinates along the two other axes, in their order. A case is the set
//! of corners inside the fluid, one bit each.
//!
//! # How it works
//!
//! The surface cuts every edge between an inside and an outside corner once. On each face the cuts
//! are joined by segments so that each run of inside corners along the border of the face is
//! separated individually: two inside corners that are diagonal on a face are separated from each
//! other. Every cut edge belongs to two faces, so the segments form closed loops. A loop is
//! triangulated with the shortest diagonals, none of which may lie in a face of the cube.
//!
//! The segments on a face depend only on its four corners, which both adjacent cubes share. The
//! triangles of adjacent cubes therefore share the same segments, in opposite directions: the mesh
//! is closed and oriented for all cases. A diagonal in a face could coincide with one of the
//! adjacent cube and produce an edge with four triangles; hence the last rule. The segments are
//! those of the table of Lorensen and Cline as corrected by Bourke ("Polygonising a scalar field",
//! 1994). The tests verify all of this for every case.

use std::sync::LazyLock;

use glam::UVec2;

/// Triangles by case, each as three edges, counter-clockwise as seen from outside the fluid.
pub(crate) static TRIANGLES: LazyLock<Vec<Vec<[u8; 3]>>> =
    LazyLock::new(|| (0..=255).map(triangulate).collect());

/// [`TRIANGLES`] for the device: per case 15 edges of 4 bits, from the lowest bit of `x` to bit 27
/// of `y`, and the number of triangles in the bits above.
pub(crate) fn packed() -> Vec<UVec2> {
    let pack = |triangles: &Vec<[u8; 3]>| {
        let edges = triangles.iter().flatten().enumerate();
        let bits = edges.fold(0_u64, |bits, (i, &edge)| bits | (u64::from(edge) << (4 * i)));
        let bits = bits | ((triangles.len() as u64) << 60);
        UVec2::new(bits as u32, (bits >> 32) as u32)
    };
    TRIANGLES.iter().map(pack).collect()
}

/// Number of triangles by case.
pub(crate) static COUNTS: LazyLock<[u8; 256]> =
    LazyLock::new(|| std::array::from_fn(|case| TRIANGLES[case].len() as u8));

/// The corners at the ends of an edge, the lower one first.
fn ends(edge: u8) -> [u8; 2] {
    let (a, b) = (edge & 1, edge >> 1 & 1);
    match edge / 4 {
        0 => [a << 1 | b << 2, 1 | a << 1 | b << 2],
        1 => [a | b << 2, 2 | a | b << 2],
        _ => [a | b << 1, 4 | a | b << 1],
    }
}

/// The edge between two adjacent corners.
fn edge_between(a: u8, b: u8) -> u8 {
    let (low, high) = (a.min(b), a.max(b));
    match high - low {
        1 => low >> 1,
        2 => 4 | low & 1 | low >> 1 & 2,
        _ => 8 | low,
    }
}

/// The corners of the faces, counter-clockwise as seen from outside the cube: low x, high x, low y,
/// ...
const FACES: [[u8; 4]; 6] =
    [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];

/// The segments on one face: from the edge at which the border enters a run of inside corners to
/// the edge at which it leaves.
fn joins(case: u8, face: [u8; 4]) -> impl Iterator<Item = (u8, u8)> {
    let inside = move |k: usize| case >> face[k % 4] & 1 == 1;
    (0..4).filter(move |&k| !inside(k) && inside(k + 1)).map(move |k| {
        let last = (k + 1..).find(|&l| !inside(l + 1)).unwrap_or(k);
        let edge = |k: usize| edge_between(face[k % 4], face[(k + 1) % 4]);
        (edge(k), edge(last))
    })
}

/// True if two edges share a face.
fn share_face(a: u8, b: u8) -> bool {
    FACES.iter().any(|face| [a, b].iter().all(|&edge| ends(edge).iter().all(|corner| face.contains(corner))))
}

/// Squared distance of the midpoints of two edges, in units of a quarter of the squared edge
/// length.
fn distance(a: u8, b: u8) -> u32 {
    let middle =
        |edge: u8, axis: u8| ends(edge).iter().map(|corner| i32::from(corner >> axis & 1)).sum::<i32>();
    (0..3).map(|axis| (middle(a, axis) - middle(b, axis)).pow(2) as u32).sum()
}

/// The triangulation of the polygon `edges` with the lowest cost, and this cost. The side between
/// the first and the last is already included in the cost.
fn split(edges: &[u8]) -> (u32, Vec<[u8; 3]>) {
    let last = edges.len() - 1;
    if last < 2 {
        return (0, Vec::new());
    }
    let diagonal = |i: usize, j: usize| match j - i {
        1 => 0,
        _ if share_face(edges[i], edges[j]) => 1000,
        _ => distance(edges[i], edges[j]),
    };
    let choices = (1..last).map(|k| {
        let (left, mut triangles) = split(&edges[..=k]);
        let (right, more) = split(&edges[k..]);
        triangles.push([edges[0], edges[k], edges[last]]);
        triangles.extend(more);
        (left + right + diagonal(0, k) + diagonal(k, last), triangles)
    });
    choices.min_by_key(|(cost, _)| *cost).unwrap_or_default()
}

fn triangulate(case: u8) -> Vec<[u8; 3]> {
    const NONE: u8 = 255;
    let mut next = [NONE; 12];
    for (from, to) in FACES.into_iter().flat_map(|face| joins(case, face)) {
        next[usize::from(from)] = to;
    }
    let mut triangles = Vec::new();
    for first in 0..12 {
        let mut polygon = Vec::new();
        let mut edge = first;
        while next[usize::from(edge)] != NONE {
            polygon.push(edge);
            edge = std::mem::replace(&mut next[usize::from(edge)], NONE);
        }
        if !polygon.is_empty() {
            triangles.extend(split(&polygon).1);
        }
    }
    triangles
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;

    /// The border of the triangles of a case: the sides whose reverse is not a side of another
    /// triangle.
    fn border(case: usize) -> Vec<(u8, u8)> {
        let mut sides = BTreeMap::new();
        for &[a, b, c] in &TRIANGLES[case] {
            for side in [(a, b), (b, c), (c, a)] {
                *sides.entry(side).or_insert(0) += 1;
            }
        }
        assert!(
            sides.values().all(|&count| count == 1),
            "case {case}: a side is used twice in one direction"
        );
        sides.keys().copied().filter(|&(a, b)| !sides.contains_key(&(b, a))).collect()
    }

    #[test]
    fn edges_and_corners_agree() {
        for edge in 0..12 {
            let [a, b] = ends(edge);
            assert_eq!(edge_between(a, b), edge);
            assert_eq!(edge_between(b, a), edge);
            assert_eq!(b - a, 1 << (edge / 4));
        }
    }

    #[test]
    fn triangle_borders_are_face_segments_and_no_diagonal_lies_in_a_face() {
        for case in 0..256 {
            let mut expected: Vec<_> = FACES.iter().flat_map(|&face| joins(case as u8, face)).collect();
            expected.sort_unstable();
            assert_eq!(border(case), expected, "case {case}");
            for &[a, b, c] in &TRIANGLES[case] {
                for side in [(a, b), (b, c), (c, a)] {
                    let on_border = expected.contains(&side);
                    assert!(on_border || !share_face(side.0, side.1), "case {case}: {side:?} lies in a face");
                }
            }
            assert!(TRIANGLES[case].len() <= 5, "case {case}");
        }
    }

    /// Every pattern of four corners on a face gives the same segments from both sides, in opposite
    /// directions.
    #[test]
    fn adjacent_cubes_share_segments() {
        for axis in 0..3 {
            let (low, high) = (FACES[2 * axis], FACES[2 * axis + 1]);
            // A corner or an edge of the high face, as a corner or an edge of the low face of the
            // adjacent cube.
            let shift_edge = |edge: u8| {
                let [a, b] = ends(edge).map(|corner| corner & !(1 << axis));
                edge_between(a, b)
            };
            for pattern in 0..16_u8 {
                let case = |face: [u8; 4]| {
                    let mut sorted = face;
                    sorted.sort_unstable();
                    (0..4).fold(0, |case, i| case | ((pattern >> i & 1) << sorted[i]))
                };
                let mut here: Vec<_> =
                    joins(case(high), high).map(|(a, b)| (shift_edge(b), shift_edge(a))).collect();
                let mut there: Vec<_> = joins(case(low), low).collect();
                here.sort_unstable();
                there.sort_unstable();
                assert_eq!(here, there, "axis {axis}, pattern {pattern:04b}");
            }
        }
    }

    /// One inside corner: the normal points away from it.
    #[test]
    fn triangles_face_outwards() {
        assert_eq!(TRIANGLES[1], [[0, 4, 8]]);
        assert_eq!(TRIANGLES[254], [[0, 8, 4]]);
    }

    #[test]
    fn packing_preserves_every_edge() {
        for (case, packed) in packed().into_iter().enumerate() {
            let bits = u64::from(packed.x) | u64::from(packed.y) << 32;
            assert_eq!(bits >> 60, u64::from(COUNTS[case]));
            for (i, &edge) in TRIANGLES[case].iter().flatten().enumerate() {
                assert_eq!(bits >> (4 * i) & 15, u64::from(edge));
            }
        }
    }
}
