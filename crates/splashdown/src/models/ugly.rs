//! How to spoil a mesh: material for tests of whatever reads and repairs meshes.

use glam::{Vec3, vec3};
use splashdown_io::Mesh;

use super::rock::random;

/// The same shape as a mesh found in the wild: the triangles share no vertices (a soup) and have no normals; every
/// tenth or so is turned over, some are there twice, some have no area or are needles; one small hole (the
/// triangles round one vertex) is open; and four tiny tetrahedra float about outside, within a tenth of the
/// mesh's extent. The seed decides which. A mesh without triangles is returned as it is.
#[must_use]
pub fn ugly(mesh: &Mesh, seed: u32) -> Mesh {
    let at = |i: u32| Vec3::from(mesh.vertices.get(i as usize).copied().unwrap_or_default());
    if mesh.is_empty() {
        return mesh.clone();
    }
    let mut dice = Dice(seed.wrapping_mul(0x9e37_79b9));
    let removed = mesh.triangles[dice.below(mesh.len())][0];
    let mut soup: Vec<[Vec3; 3]> = Vec::with_capacity(mesh.len() * 5 / 4);
    for corners in &mesh.triangles {
        if corners.contains(&removed) {
            continue;
        }
        let [a, b, c] = corners.map(at);
        soup.push(if dice.chance(0.1) { [a, c, b] } else { [a, b, c] });
        if dice.chance(0.03) {
            soup.push(if dice.chance(0.5) { [a, c, b] } else { [a, b, c] });
        }
        if dice.chance(0.02) {
            soup.push([a, a, b]);
        }
        if dice.chance(0.02) {
            // A needle along an edge, one corner a thousandth of the edge off it.
            let off = 1e-3 * (c - a);
            soup.push([a, b, a.midpoint(b) + off]);
        }
    }
    let (low, high) = mesh
        .vertices
        .iter()
        .map(|&v| Vec3::from(v))
        .fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
    let size = (high - low).length();
    for _ in 0..4 {
        let place = vec3(dice.roll(), dice.roll(), dice.roll());
        let center = (low + place * (high - low)).with_y(high.y + 0.1 * size * (0.5 + 0.5 * dice.roll()));
        let [o, x, y, z] = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z].map(|v| center + 0.005 * size * v);
        soup.extend([[o, y, x], [o, z, y], [o, x, z], [x, y, z]]);
    }
    // No order either: a reader must not learn from it.
    for i in (1..soup.len()).rev() {
        soup.swap(i, dice.below(i + 1));
    }
    Mesh::new(
        soup.iter().flatten().map(Vec3::to_array).collect(),
        (0..soup.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
    )
}

/// Random numbers in a row.
struct Dice(u32);

impl Dice {
    /// In [0, 1).
    fn roll(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(1);
        random(self.0)
    }

    fn chance(&mut self, part: f32) -> bool {
        self.roll() < part
    }

    /// A whole number below `limit`, which is at least 1.
    fn below(&mut self, limit: usize) -> usize {
        ((f64::from(self.roll()) * limit as f64) as usize).min(limit - 1)
    }
}
