//! Spray in pictures: small components of the surface become droplets.
//!
//! The surface of a few particles has the size of the marching-cubes cells and looks like gravel.
//! Pictures show each of its particles as a group of droplets with the volume of the particle
//! instead: water of this size breaks up into drops that the simulation does not resolve. Sizes and
//! places within a group follow from the index of the particle, so that they stay the same from
//! frame to frame.

use splashdown::glam::{IVec3, Mat3, Vec3};
use splashdown::surface::take_small_components;
use splashdown_io::{Mesh, Particles};
use std::collections::HashMap;

/// Components of less volume than this number of particles become droplets.
const LARGEST: f64 = 9.0;
/// Droplets per particle.
const GROUP: u32 = 7;
/// Largest distance of a droplet from its particle, in spacings.
const SCATTER: f32 = 1.1;

/// Replaces the small components of a mesh by droplets at their particles.
pub(super) fn with_droplets(mesh: &Mesh, particles: &Particles, spacing: f32) -> Mesh {
    let mut mesh = mesh.clone();
    let boxes = take_small_components(&mut mesh, LARGEST * f64::from(spacing).powi(3));
    if boxes.is_empty() || particles.positions.is_empty() {
        return mesh;
    }
    // The boxes by cells of two spacings; a box is at most a few cells wide.
    let cell = |x: Vec3| (x / (2.0 * spacing)).floor().as_ivec3();
    let mut near: HashMap<IVec3, Vec<usize>> = HashMap::new();
    for (i, [low, high]) in boxes.iter().enumerate() {
        let (low, high) = (cell((*low).into()), cell((*high).into()));
        for x in low.x..=high.x {
            for y in low.y..=high.y {
                for z in low.z..=high.z {
                    near.entry(IVec3::new(x, y, z)).or_default().push(i);
                }
            }
        }
    }
    let sphere = Sphere::new();
    for (i, &position) in particles.positions.iter().enumerate() {
        let x = Vec3::from(position);
        let inside = |&b: &usize| {
            let [low, high] = boxes[b].map(Vec3::from);
            x.cmpge(low).all() && x.cmple(high).all()
        };
        if near.get(&cell(x)).is_some_and(|boxes| boxes.iter().any(inside)) {
            let id = particles.ids.get(i).copied().unwrap_or(i as u32);
            for (offset, radius) in group(id) {
                sphere.add(&mut mesh, x + spacing * offset, spacing * radius);
            }
        }
    }
    mesh
}

/// Offsets and radii in spacings of the droplets of a particle. Their volumes sum to that of a cube of one spacing.
fn group(id: u32) -> impl Iterator<Item = (Vec3, f32)> {
    let random = move |i: u32| noise(id.wrapping_mul(64).wrapping_add(i)) as f32 / u32::MAX as f32;
    // A wide range of sizes: volumes fall geometrically.
    let share = move |k: u32| 0.5_f32.powi(k as i32) * (0.5 + random(k));
    let total: f32 = (0..GROUP).map(share).sum();
    (0..GROUP).map(move |k| {
        let radius = (share(k) / total / (4.0 / 3.0 * std::f32::consts::PI)).cbrt();
        let direction = Vec3::new(random(16 + k), random(24 + k), random(32 + k)) * 2.0 - 1.0;
        let reach = if k == 0 { 0.2 } else { SCATTER * random(40 + k) };
        (direction.normalize_or_zero() * reach, radius)
    })
}

/// A pseudo-random number (PCG hash, Jarzynski and Olano 2020).
fn noise(value: u32) -> u32 {
    let state = value.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (word >> 22) ^ word
}

/// A unit sphere: an octahedron of which every triangle is divided into 16.
struct Sphere {
    vertices: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
}

impl Sphere {
    fn new() -> Self {
        let mut triangles: Vec<[Vec3; 3]> = Vec::new();
        for k in 0..8_u32 {
            let sign = |bit: u32| if k >> bit & 1 == 0 { 1.0 } else { -1.0 };
            let corners = Mat3::from_diagonal(Vec3::new(sign(0), sign(1), sign(2)));
            let [a, b, c] = [corners.x_axis, corners.y_axis, corners.z_axis];
            triangles.push(if k.count_ones() % 2 == 0 { [a, b, c] } else { [a, c, b] });
        }
        for _ in 0..2 {
            let divide = |[a, b, c]: [Vec3; 3]| {
                let [ab, bc, ca] = [a + b, b + c, c + a].map(|sum| sum.normalize_or_zero());
                [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
            };
            triangles = triangles.into_iter().flat_map(divide).collect();
        }
        let mut sphere = Self { vertices: Vec::new(), triangles: Vec::new() };
        let mut known: HashMap<[i32; 3], u32> = HashMap::new();
        for triangle in triangles {
            let indices = triangle.map(|corner| {
                let key = (corner * 1e4).round().as_ivec3().to_array();
                *known.entry(key).or_insert_with(|| {
                    sphere.vertices.push(corner);
                    sphere.vertices.len() as u32 - 1
                })
            });
            sphere.triangles.push(indices);
        }
        sphere
    }

    fn add(&self, mesh: &mut Mesh, centre: Vec3, radius: f32) {
        let first = mesh.vertices.len() as u32;
        mesh.vertices.extend(self.vertices.iter().map(|&x| (centre + radius * x).to_array()));
        if mesh.normals.len() == first as usize {
            mesh.normals.extend(self.vertices.iter().map(|x| x.to_array()));
        }
        mesh.triangles.extend(self.triangles.iter().map(|t| t.map(|v| first + v)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use splashdown::surface::{SurfaceParams, reconstruct_with};
    use splashdown_gpu::{CpuExecutor, Executor};

    const SPACING: f32 = 0.1;

    fn block_and_drop() -> (Mesh, Particles) {
        let mut positions: Vec<[f32; 3]> =
            (0..512).map(|i| [i % 8, i / 8 % 8, i / 64].map(|c| SPACING * c as f32)).collect();
        positions.push([2.0, 0.0, 0.0]);
        let mut executor = Executor::from(CpuExecutor::new());
        let (mesh, _) = reconstruct_with(&positions, &SurfaceParams::new(SPACING), &mut executor).unwrap();
        (mesh, Particles::from_positions(positions))
    }

    #[test]
    fn a_lone_particle_becomes_droplets_of_its_volume() {
        let (mesh, particles) = block_and_drop();
        let drawn = with_droplets(&mesh, &particles, SPACING);
        let topology = drawn.topology().unwrap();
        assert!(topology.is_watertight(), "{topology}");
        assert_eq!(topology.components, 1 + GROUP as usize);
        let mut block = mesh.clone();
        take_small_components(&mut block, LARGEST * f64::from(SPACING).powi(3));
        let droplets = drawn.volume() - block.volume();
        // Polyhedra are smaller than their spheres.
        let ratio = droplets / f64::from(SPACING).powi(3);
        assert!((0.90..1.0).contains(&ratio), "{ratio}");
        // Negative control: the component of the mesh has another volume.
        let ratio = (mesh.volume() - block.volume()) / f64::from(SPACING).powi(3);
        assert!(!(0.90..1.0).contains(&ratio), "{ratio}");
    }

    #[test]
    fn droplets_keep_size_and_offset_from_frame_to_frame() {
        let offsets = |id| group(id).collect::<Vec<_>>();
        assert_eq!(offsets(7), offsets(7));
        assert_ne!(offsets(7), offsets(8));
        assert!(group(7).all(|(offset, radius)| offset.length() <= SCATTER && radius < 0.6));
    }
}
