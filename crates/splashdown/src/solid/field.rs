//! Signed distances on a grid, and the fraction of the kernel that the solid fills.

use glam::{UVec3, Vec2, Vec3};
use rayon::prelude::*;

use super::bvh::Bvh;
use super::surroundings::{Surroundings, filled};
use crate::boundary::PlaneFraction;

/// Distances on the nodes of a grid around a solid, in the frame of its mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct DistanceField {
    /// The first node, in m.
    pub min: Vec3,
    /// Distance between the nodes in m.
    pub cell_size: f32,
    /// Number of nodes along each axis.
    pub nodes: [u32; 3],
    /// Per node, x fastest: the signed distance in m, negative inside; and the effective distance in m, which is the distance of
    /// the plane wall that fills the same fraction of the kernel. Both are interpolated linearly; with an implicit pressure the
    /// second is the coefficient of a quadratic B-spline.
    pub values: Vec<Vec2>,
}

/// Edge length of a block in nodes. All nodes of a block that is far from the surface get one value.
const BLOCK: u32 = 8;
/// Number of quadrature points along the diameter of the kernel.
const POINTS: i32 = 12;

impl DistanceField {
    /// Computes the distances. With `half_thickness` the mesh is a shell; without it the winding number
    /// decides between inside and outside.
    pub(super) fn new(
        bvh: &Bvh,
        bounds: (Vec3, Vec3),
        cell_size: f32,
        support_radius: f32,
        half_thickness: Option<f32>,
        progress: &(dyn Fn(f32) + Sync),
    ) -> Self {
        let margin = support_radius + half_thickness.unwrap_or(0.0) + 2.0 * cell_size;
        let min = bounds.0 - margin;
        let nodes = ((bounds.1 - bounds.0 + 2.0 * margin) / cell_size).ceil().as_uvec3() + UVec3::ONE;
        let mut field = Self { min, cell_size, nodes: nodes.to_array(), values: Vec::new() };
        let band = support_radius + 4.0 * cell_size + half_thickness.unwrap_or(0.0);
        let blocks = (nodes + UVec3::splat(BLOCK - 1)) / BLOCK;
        let slabs: Vec<Vec<f32>> = (0..blocks.z)
            .into_par_iter()
            .map(|z| {
                let slab = field.slab(bvh, z * BLOCK, band, half_thickness);
                progress(0.5 / blocks.z as f32);
                slab
            })
            .collect();
        field.values = slabs.into_iter().flatten().map(Vec2::splat).collect();
        field
    }

    /// Adds sheets with a thickness.
    pub(super) fn add_sheets(&mut self, sheets: &Bvh, half_thickness: f32) {
        let [nx, ny, _] = self.nodes;
        let nodes: Vec<f32> = self
            .values
            .par_iter()
            .enumerate()
            .map(|(k, value)| {
                let k = k as u32;
                let x = self.node(UVec3::new(k % nx, k / nx % ny, k / (nx * ny)));
                // Only a sheet that is nearer than the solid changes the value.
                let most = (value.x + half_thickness).max(0.0);
                value.x.min(sheets.distance(x, most) - half_thickness)
            })
            .collect();
        self.values = nodes.into_iter().map(Vec2::splat).collect();
    }

    /// Whether a point is within the grid.
    pub(super) fn covers(&self, x: Vec3) -> bool {
        let last = UVec3::from_array(self.nodes) - UVec3::ONE;
        x.cmpge(self.min).all() && x.cmple(self.node(last)).all()
    }

    /// The distances of up to `BLOCK` planes of nodes, starting at `first_z`.
    fn slab(&self, bvh: &Bvh, first_z: u32, band: f32, half_thickness: Option<f32>) -> Vec<f32> {
        let [nx, ny, nz] = self.nodes;
        let depth = BLOCK.min(nz - first_z);
        let mut slab = vec![0.0; (nx * ny * depth) as usize];
        let index = |x: u32, y: u32, z: u32| ((z * ny + y) * nx + x) as usize;
        let half = 0.5 * BLOCK as f32 * self.cell_size;
        for block_y in (0..ny).step_by(BLOCK as usize) {
            for block_x in (0..nx).step_by(BLOCK as usize) {
                let corner = UVec3::new(block_x, block_y, first_z);
                let center = self.min + corner.as_vec3() * self.cell_size + half;
                let at_center = bvh.distance(center, f32::INFINITY);
                let nearest = at_center - 1.75 * half;
                let far = nearest > band;
                let sign =
                    |x: Vec3| if half_thickness.is_none() && bvh.winding(x) > 0.5 { -1.0 } else { 1.0 };
                let block_sign = if far { sign(center) } else { 1.0 };
                for z in 0..depth {
                    for y in block_y..(block_y + BLOCK).min(ny) {
                        let (mut last, mut last_sign) = (f32::INFINITY, 0.0);
                        for x in block_x..(block_x + BLOCK).min(nx) {
                            slab[index(x, y, z)] = if far {
                                block_sign * nearest
                            } else {
                                let p = self.node(UVec3::new(x, y, first_z + z));
                                let d = bvh.distance(p, 1.001 * (last + self.cell_size));
                                match half_thickness {
                                    Some(half) => d - half,
                                    None => {
                                        // The sign cannot change between two nodes if the first one is
                                        // farther from the surface than from the second.
                                        if last_sign == 0.0 || last.abs() <= self.cell_size {
                                            last_sign = sign(p);
                                        }
                                        last = d;
                                        last_sign * d
                                    }
                                }
                            };
                        }
                    }
                }
            }
        }
        slab
    }

    /// Computes the effective distances: those of the plane that fills the same fraction of the kernel.
    ///
    /// The fraction D is that of `fraction`, by a quadrature over the points of the kernel's support, each weighted with the part of
    /// its cell that is inside. It is scaled by the ratio of the exact value and the quadrature for a plane
    /// wall at the same distance. The result is exact for a plane, and quadrature errors cancel for small
    /// fractions.
    pub(super) fn fill_effective(
        &mut self,
        support_radius: f32,
        fraction: PlaneFraction,
        surroundings: Option<&Surroundings<'_>>,
        progress: &(dyn Fn(f32) + Sync),
    ) {
        let step = 2.0 / POINTS as f32;
        let axis = || (0..POINTS).map(move |k| -1.0 + (k as f32 + 0.5) * step);
        let mut ball: Vec<(Vec3, f32)> = Vec::new();
        for z in axis() {
            for y in axis() {
                for x in axis() {
                    let r = Vec3::new(x, y, z);
                    if r.length() < 1.0 {
                        let r = r * support_radius;
                        ball.push((r, fraction.weight(r.length(), support_radius)));
                    }
                }
            }
        }
        let total: f32 = ball.iter().map(|(_, w)| w).sum();
        ball.iter_mut().for_each(|(_, w)| *w /= total);
        let quadrature = Quadrature { support: support_radius, fraction, ball, size: step * support_radius };
        let plane = (self.nodes[0] * self.nodes[1]) as usize;
        let slices = self.nodes[2];
        let effective: Vec<Vec<f32>> = (0..slices)
            .into_par_iter()
            .map(|z| {
                let slice = (0..plane as u32)
                    .map(|k| {
                        let at = UVec3::new(k % self.nodes[0], k / self.nodes[0], z);
                        let mut x = self.node(at);
                        let mut phi = self.values[z as usize * plane + k as usize].x;
                        // Behind a closed side lies the image of what is in front of it.
                        if let Some(surroundings) = surroundings {
                            x = surroundings.fold(x);
                            phi = self.distance(x);
                        }
                        if phi.abs() >= support_radius {
                            return phi;
                        }
                        let near =
                            surroundings.filter(|surroundings| surroundings.is_near(x, support_radius));
                        self.effective(x, phi, &quadrature, near)
                    })
                    .collect();
                progress(0.5 / slices as f32);
                slice
            })
            .collect();
        for (value, effective) in self.values.iter_mut().zip(effective.into_iter().flatten()) {
            value.y = effective;
        }
    }

    fn effective(
        &self,
        x: Vec3,
        phi: f32,
        quadrature: &Quadrature,
        surroundings: Option<&Surroundings<'_>>,
    ) -> f32 {
        let &Quadrature { support, fraction, ref ball, size } = quadrature;
        // The gradient vanishes in the middle of a wall or slot. A plane of any orientation is a valid
        // reference there.
        let normal = self.slope(x).normalize_or(Vec3::X);
        let (mut solid, mut plane) = (0.0, 0.0);
        for &(r, w) in ball {
            solid += w * match surroundings {
                None => filled(self.distance(x + r), size),
                Some(surroundings) => surroundings.share(self, x + r, size),
            };
            plane += w * filled(phi + normal.dot(r), size);
        }
        if plane <= 1e-7 {
            return phi;
        }
        let exact = fraction.at(phi, support);
        // Above one half the complement is the small quantity, so the ratio is applied to it.
        let part = if exact > 0.5 {
            1.0 - (1.0 - exact) * ((1.0 - solid) / (1.0 - plane).max(1e-7))
        } else {
            exact * solid / plane
        };
        fraction.distance(part.clamp(0.0, 1.0), support)
    }

    /// The unit normal of the surface at a point of the mesh's frame, or zero.
    pub(crate) fn normal(&self, x: Vec3) -> Vec3 {
        self.slope(x).normalize_or_zero()
    }

    /// The difference of the distances half a cell before and behind a point, per axis.
    fn slope(&self, x: Vec3) -> Vec3 {
        let e = 0.5 * self.cell_size;
        let along = |axis: Vec3| self.distance(x + e * axis) - self.distance(x - e * axis);
        Vec3::new(along(Vec3::X), along(Vec3::Y), along(Vec3::Z))
    }

    /// The position of a node in m.
    pub fn node(&self, at: UVec3) -> Vec3 {
        self.min + at.as_vec3() * self.cell_size
    }

    /// The signed distance in m at a point of the mesh's frame, by trilinear interpolation. Outside the grid
    /// it is the value at the nearest point of the grid's boundary plus the distance to that point.
    pub fn distance(&self, x: Vec3) -> f32 {
        let size = UVec3::from_array(self.nodes);
        let high = self.min + (size - UVec3::ONE).as_vec3() * self.cell_size;
        let p = x.clamp(self.min, high);
        let at = (p - self.min) / self.cell_size;
        let cell = at.as_uvec3().min(size - UVec3::splat(2));
        let f = at - cell.as_vec3();
        let (row, plane) = (size.x as usize, (size.x * size.y) as usize);
        let first = cell.z as usize * plane + cell.y as usize * row + cell.x as usize;
        let node = |k: usize| self.values[first + k].x;
        let mix = |a: f32, b: f32, t: f32| a + (b - a) * t;
        let y0 = mix(mix(node(0), node(1), f.x), mix(node(row), node(row + 1), f.x), f.y);
        let far = plane + row;
        let y1 = mix(mix(node(plane), node(plane + 1), f.x), mix(node(far), node(far + 1), f.x), f.y);
        mix(y0, y1, f.z) + p.distance(x)
    }
}

/// The points of a ball of the kernel's support.
struct Quadrature {
    /// The support radius in m.
    support: f32,
    fraction: PlaneFraction,
    /// Points relative to the centre in m, with weights that add up to 1.
    ball: Vec<(Vec3, f32)>,
    /// Distance between the points in m.
    size: f32,
}
