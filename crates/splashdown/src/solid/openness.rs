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
use rayon::prelude::*;

use super::bvh::Bvh;
use super::repair::Edges;

/// A mesh is a shell if more than this part of it is missing.
const OPEN: f64 = 0.08;
/// An open piece is a fin if more than this part seems to be missing there, and if it has at least the second part of the
/// mesh's area. Smaller pieces are debris.
const FIN: f64 = 0.7;
const FIN_AREA: f64 = 0.01;
/// Points of a piece and of a mesh at which the winding number is computed.
const PIECE_SAMPLES: usize = 64;
const SAMPLES: usize = 1024;
/// Multiple of a cluster's radius beyond which its winding number is approximated. The error must be small, because it is
/// compared with the missing part.
const FAR: f32 = 8.0;

/// The result for a mesh.
pub(super) struct Openness {
    /// Whether the mesh is a shell.
    pub is_shell: bool,
    /// The missing part in thousandths.
    pub missing: u32,
    /// Number of triangles of fins.
    pub fins: u32,
    is_fin: Vec<bool>,
}

impl Openness {
    /// Estimates the missing part of a mesh with oriented pieces.
    pub fn of(vertices: &[Vec3], triangles: &[[u32; 3]], pieces: &[Vec<u32>], edges: &Edges) -> Self {
        let surface = Surface::new(vertices, triangles);
        let is_open = |t: u32| {
            let triangle = triangles[t as usize];
            (0..3).any(|k| {
                let [a, b] = [triangle[k], triangle[(k + 1) % 3]];
                edges.get(&[a.min(b), a.max(b)]).is_some_and(|sharing| sharing.len() == 1)
            })
        };
        let total: f64 = surface.areas.iter().sum();
        let area_of = |piece: &[u32]| piece.iter().map(|&t| surface.areas[t as usize]).sum::<f64>();
        let mut is_fin = vec![false; triangles.len()];
        let (mut rest, mut open) = (0.0, Vec::new());
        for piece in pieces {
            let area = area_of(piece);
            let has_edge = piece.iter().any(|&t| is_open(t));
            if has_edge && area > FIN_AREA * total && surface.missing(piece, PIECE_SAMPLES) > FIN {
                piece.iter().for_each(|&t| is_fin[t as usize] = true);
                continue;
            }
            rest += area;
            if has_edge {
                open.extend_from_slice(piece);
            }
        }
        // Closed pieces have all of their surface.
        let part = if rest > 0.0 { surface.missing(&open, SAMPLES) * area_of(&open) / rest } else { 1.0 };
        // What remains without fins may be debris.
        let is_shell = rest <= FIN_AREA * total || part > OPEN;
        if is_shell {
            is_fin.fill(false);
        }
        let fins = is_fin.iter().filter(|fin| **fin).count() as u32;
        Self { is_shell, missing: (1000.0 * part).round() as u32, fins, is_fin }
    }

    /// The triangles with those of the fins at the end.
    pub fn fins_last(&self, triangles: Vec<[u32; 3]>) -> Vec<[u32; 3]> {
        let part = |fin: bool| triangles.iter().zip(&self.is_fin).filter(move |(_, is)| **is == fin);
        part(false).chain(part(true)).map(|(triangle, _)| *triangle).collect()
    }
}

/// The triangles with their areas in m^2.
struct Surface {
    corners: Vec<[Vec3; 3]>,
    areas: Vec<f64>,
    tree: Bvh,
}

impl Surface {
    fn new(vertices: &[Vec3], triangles: &[[u32; 3]]) -> Self {
        let corners: Vec<[Vec3; 3]> = triangles.iter().map(|t| t.map(|v| vertices[v as usize])).collect();
        let area = |[a, b, c]: &[Vec3; 3]| 0.5 * f64::from((b - a).cross(c - a).length());
        Self { areas: corners.iter().map(area).collect(), tree: Bvh::new(corners.clone()), corners }
    }

    /// The missing part, 0 to 1, as seen from points that are evenly distributed over the area of these triangles.
    fn missing(&self, triangles: &[u32], samples: usize) -> f64 {
        let total: f64 = triangles.iter().map(|&t| self.areas[t as usize]).sum();
        let (mut sum, mut chosen) = (0.0, Vec::with_capacity(samples));
        for &t in triangles {
            sum += self.areas[t as usize];
            while chosen.len() < samples && (chosen.len() as f64 + 0.5) * total < sum * samples as f64 {
                chosen.push(t);
            }
        }
        let parts: Vec<f64> = chosen.par_iter().map(|&t| self.missing_at(t)).collect();
        let mean = parts.iter().sum::<f64>() / parts.len().max(1) as f64;
        mean.clamp(0.0, 1.0)
    }

    /// The missing part as seen from a triangle. Errors of both signs cancel in the mean; parts of a surface that are
    /// inside another piece do not.
    fn missing_at(&self, t: u32) -> f64 {
        let [a, b, c] = self.corners[t as usize];
        let normal = (b - a).cross(c - a);
        let step = 1e-2 * normal.length().sqrt() * normal.normalize_or_zero();
        let middle = (a + b + c) / 3.0;
        // The triangle's own part is 0.5 on one side and -0.5 on the other.
        let both = self.tree.winding_to(middle + step, FAR) + self.tree.winding_to(middle - step, FAR);
        f64::from(1.0 - both).clamp(-0.2, 1.0)
    }
}
