//! How open a mesh is: whether it is a solid with holes or a sheet, and which parts of a solid are open fins.
//!
//! *How it works.* On a closed surface the generalised winding number is 1 on one side and 0 on the other, so its mean at
//! the surface is 0.5. What is missing lowers the mean: by p / 2 if a part p of the triangles is missing at random, by the
//! solid angle of a large hole, and to 0 on a single sheet. Twice the deficit, averaged over the area, estimates the
//! missing part. It only grows when triangles are removed.
//!
//! *Why not the area of the loops of open edges:* the loops of neighbouring holes merge, and their vector areas cancel. A
//! mesh without 40 % of its triangles then seems less open than one without 10 %.

use glam::Vec3;

use super::bvh::Bvh;
use super::repair::Edges;

/// A mesh is a shell if more than this part of it is missing.
const OPEN: f64 = 0.08;
/// An open piece is a fin if more than this part seems to be missing there, and if it has at least the second part of the
/// mesh's area. Smaller pieces are debris.
const FIN: f64 = 0.7;
const FIN_AREA: f64 = 0.01;
/// Triangles per piece at which the winding number is computed.
const SAMPLES: usize = 256;

/// The result for a mesh.
pub(super) struct Openness {
    /// Whether the mesh is a shell.
    pub is_shell: bool,
    /// Number of triangles of fins.
    pub fins: u32,
    is_fin: Vec<bool>,
}

impl Openness {
    /// Estimates the missing part of a mesh with oriented pieces.
    pub fn of(vertices: &[Vec3], triangles: &[[u32; 3]], pieces: &[Vec<u32>], edges: &Edges) -> Self {
        let corners = |t: u32| triangles[t as usize].map(|v| vertices[v as usize]);
        let tree = Bvh::new((0..triangles.len() as u32).map(corners).collect());
        let area = |t: u32| {
            let [a, b, c] = corners(t);
            0.5 * f64::from((b - a).cross(c - a).length())
        };
        let is_open = |t: u32| {
            let triangle = triangles[t as usize];
            (0..3).any(|k| {
                let [a, b] = [triangle[k], triangle[(k + 1) % 3]];
                edges.get(&[a.min(b), a.max(b)]).is_some_and(|sharing| sharing.len() == 1)
            })
        };
        let areas: Vec<f64> = pieces.iter().map(|piece| piece.iter().map(|&t| area(t)).sum()).collect();
        let total: f64 = areas.iter().sum();
        let missing: Vec<f64> = pieces
            .iter()
            .map(|piece| {
                if !piece.iter().any(|&t| is_open(t)) {
                    return 0.0;
                }
                let samples = piece.iter().step_by(piece.len().div_ceil(SAMPLES));
                let (weighted, weights) = samples.fold((0.0, 0.0), |(sum, weights), &t| {
                    (sum + area(t) * missing_at(&tree, corners(t)), weights + area(t))
                });
                if weights > 0.0 { weighted / weights } else { 0.0 }
            })
            .collect();
        let is_fin: Vec<bool> =
            missing.iter().zip(&areas).map(|(part, area)| *part > FIN && *area > FIN_AREA * total).collect();
        let (mut rest, mut lost) = (0.0, 0.0);
        for ((part, area), _) in missing.iter().zip(&areas).zip(&is_fin).filter(|(_, fin)| !**fin) {
            rest += area;
            lost += area * part;
        }
        // What remains without fins may be debris.
        let is_shell = rest <= FIN_AREA * total || lost > OPEN * rest;
        let mut fin_of = vec![false; triangles.len()];
        for (piece, _) in pieces.iter().zip(&is_fin).filter(|(_, fin)| **fin && !is_shell) {
            piece.iter().for_each(|&t| fin_of[t as usize] = true);
        }
        Self { is_shell, fins: fin_of.iter().filter(|fin| **fin).count() as u32, is_fin: fin_of }
    }

    /// The triangles with those of the fins at the end.
    pub fn fins_last(&self, triangles: Vec<[u32; 3]>) -> Vec<[u32; 3]> {
        let part = |fin: bool| triangles.iter().zip(&self.is_fin).filter(move |(_, is)| **is == fin);
        part(false).chain(part(true)).map(|(triangle, _)| *triangle).collect()
    }
}

/// The missing part as seen from a triangle, 0 to 1.
fn missing_at(tree: &Bvh, [a, b, c]: [Vec3; 3]) -> f64 {
    let normal = (b - a).cross(c - a);
    let step = 1e-3 * normal.length().sqrt() * normal.normalize_or_zero();
    let middle = (a + b + c) / 3.0;
    // The triangle's own part is 0.5 on one side and -0.5 on the other.
    let mean = 0.5 * (tree.winding(middle + step) + tree.winding(middle - step));
    f64::from(1.0 - 2.0 * mean).clamp(0.0, 1.0)
}
