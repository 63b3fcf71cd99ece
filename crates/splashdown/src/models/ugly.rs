//! Damages meshes, for tests of mesh readers and mesh repair.

use glam::{Vec3, vec3};
use splashdown_io::Mesh;

use super::rock::random;

/// A damaged copy of a mesh, with the defects of typical mesh files. The triangles share no vertices and have
/// no normals. About a tenth of them are reversed, some are duplicated, and some have no area or are needles.
/// The triangles around one vertex are missing, which leaves a hole. Four tiny separate tetrahedra lie above
/// the mesh, within a tenth of its size. The seed selects the affected triangles. A mesh without triangles is
/// returned unchanged.
#[must_use]
pub fn ugly(mesh: &Mesh, seed: u32) -> Mesh {
    let at = |i: u32| Vec3::from(mesh.vertices.get(i as usize).copied().unwrap_or_default());
    if mesh.is_empty() {
        return mesh.clone();
    }
    let mut random = Random(seed.wrapping_mul(0x9e37_79b9));
    let removed = mesh.triangles[random.below(mesh.len())][0];
    let mut soup: Vec<[Vec3; 3]> = Vec::with_capacity(mesh.len() * 5 / 4);
    for corners in &mesh.triangles {
        if corners.contains(&removed) {
            continue;
        }
        let [a, b, c] = corners.map(at);
        soup.push(if random.chance(0.1) { [a, c, b] } else { [a, b, c] });
        if random.chance(0.03) {
            soup.push(if random.chance(0.5) { [a, c, b] } else { [a, b, c] });
        }
        if random.chance(0.02) {
            soup.push([a, a, b]);
        }
        if random.chance(0.02) {
            // A needle: the third corner is almost on the edge between the other two.
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
        let place = vec3(random.next(), random.next(), random.next());
        let center = (low + place * (high - low)).with_y(high.y + 0.1 * size * (0.5 + 0.5 * random.next()));
        let [o, x, y, z] = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z].map(|v| center + 0.005 * size * v);
        soup.extend([[o, y, x], [o, z, y], [o, x, z], [x, y, z]]);
    }
    // A random order, so that a reader cannot rely on the original one.
    for i in (1..soup.len()).rev() {
        soup.swap(i, random.below(i + 1));
    }
    Mesh::new(
        soup.iter().flatten().map(Vec3::to_array).collect(),
        (0..soup.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
    )
}

/// A sequence of pseudo-random numbers.
struct Random(u32);

impl Random {
    /// The next number in [0, 1).
    fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(1);
        random(self.0)
    }

    fn chance(&mut self, probability: f32) -> bool {
        self.next() < probability
    }

    /// The next integer below `limit`, which is at least 1.
    fn below(&mut self, limit: usize) -> usize {
        ((f64::from(self.next()) * limit as f64) as usize).min(limit - 1)
    }
}
