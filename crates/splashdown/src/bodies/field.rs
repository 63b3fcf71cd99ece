//! Interpolation of a body's map and sums over its boundary particles on the CPU; see
//! [`boundary_lookup`](super::boundary_lookup) and [`surface::solids`](crate::surface).

use glam::{UVec3, Vec2, Vec3, Vec4, Vec4Swizzles};
use splashdown_gpu::WgslModule;

use super::types::Body;
use crate::boundary::closed_bounds;
use crate::kernel::Kernel;
use crate::solid::spline;
use crate::state::Params;

/// The WGSL side of the maps, which imports [`BODY`](super::BODY).
pub(crate) const MAP: WgslModule = WgslModule { name: "sph/body_map", source: include_str!("body_map.wgsl") };

/// The inside of the closed sides of the domain.
pub(super) struct Interior {
    /// Corners in m, infinite at open sides.
    low: Vec3,
    high: Vec3,
    spacing: f32,
}

impl Interior {
    pub fn new(params: &Params) -> Self {
        let [low, high] = closed_bounds(params.domain_min, params.domain_max, params.closed);
        Self { low, high, spacing: params.particle_spacing }
    }

    /// Whether all cells of one spacing within `reach` of a point lie inside.
    fn holds(&self, x: Vec3, reach: f32) -> bool {
        let reach = reach + 0.5 * self.spacing;
        x.cmpgt(self.low + reach).all() && x.cmplt(self.high - reach).all()
    }

    /// The part of a cell of one spacing around a point that lies inside.
    fn part(&self, x: Vec3) -> f32 {
        let inside = (x - self.low).min(self.high - x) / self.spacing;
        (inside + 0.5).clamp(Vec3::ZERO, Vec3::ONE).element_product()
    }
}

/// The values of a body's map at a point, by linear interpolation.
pub(super) struct Field {
    /// Signed distance in m.
    pub distance: f32,
    /// Effective distance in m.
    pub effective: f32,
    /// Gradient of the signed distance in the mesh's frame.
    pub distance_gradient: Vec3,
    /// Gradient of the effective distance in the mesh's frame.
    pub effective_gradient: Vec3,
}

/// The values of the map at a point of the mesh's frame; `None` if the body is farther than the support radius.
#[inline]
pub(super) fn at(body: &Body, maps: &[Vec2], y: Vec3, support: f32) -> Option<Field> {
    let size = UVec3::new(body.nodes_x, body.nodes_y, body.nodes_z);
    let high = body.field_min + (size - UVec3::ONE).as_vec3() * body.cell_size;
    if y.cmple(body.field_min).any() || y.cmpge(high).any() {
        return None;
    }
    let inverse = 1.0 / body.cell_size;
    let at = (y - body.field_min) * inverse;
    let cell = at.as_uvec3().min(size - UVec3::splat(2));
    let f = at - cell.as_vec3();
    let (row, plane) = (size.x as usize, (size.x * size.y) as usize);
    let first = body.first_node as usize + cell.z as usize * plane + cell.y as usize * row + cell.x as usize;
    let node = |k: usize| maps[first + k];
    // Distances differ by at most a cell between neighbouring nodes, so one read rejects most particles.
    if node(0).min_element() >= support + 3.0 * body.cell_size {
        return None;
    }
    let (c000, c100, c010, c110) = (node(0), node(1), node(row), node(row + 1));
    let (c001, c101, c011, c111) = (node(plane), node(plane + 1), node(plane + row), node(plane + row + 1));
    let mix = |a: Vec2, b: Vec2, t: f32| a * (1.0 - t) + b * t;
    let (x00, x10) = (mix(c000, c100, f.x), mix(c010, c110, f.x));
    let (x01, x11) = (mix(c001, c101, f.x), mix(c011, c111, f.x));
    let (y0, y1) = (mix(x00, x10, f.y), mix(x01, x11, f.y));
    let value = mix(y0, y1, f.z);
    if value.min_element() >= support {
        return None;
    }
    let dx = mix(mix(c100 - c000, c110 - c010, f.y), mix(c101 - c001, c111 - c011, f.y), f.z) * inverse;
    let dy = mix(x10 - x00, x11 - x01, f.z) * inverse;
    let dz = (y1 - y0) * inverse;
    Some(Field {
        distance: value.x,
        effective: value.y,
        distance_gradient: Vec3::new(dx.x, dy.x, dz.x),
        effective_gradient: Vec3::new(dx.y, dy.y, dz.y),
    })
}

/// The effective distance in m at a point of the mesh's frame inside the map, and its gradient, by a spline whose gradient is
/// continuous.
#[inline]
pub(super) fn effective_at(body: &Body, maps: &[Vec2], y: Vec3) -> (f32, Vec3) {
    let size = UVec3::new(body.nodes_x, body.nodes_y, body.nodes_z);
    let inverse = 1.0 / body.cell_size;
    let (first, weights, slopes) = spline::weights((y - body.field_min) * inverse, size);
    let (row, plane) = (size.x as usize, (size.x * size.y) as usize);
    let first =
        body.first_node as usize + first.z as usize * plane + first.y as usize * row + first.x as usize;
    // The value and the derivatives along x, y and z.
    let mut sum = Vec4::ZERO;
    for k in 0..3 {
        for j in 0..3 {
            let at = first + k * plane + j * row;
            let line = Vec3::new(maps[at].y, maps[at + 1].y, maps[at + 2].y);
            let value = line.dot(Vec3::new(weights[0].x, weights[1].x, weights[2].x));
            let slope = line.dot(Vec3::new(slopes[0].x, slopes[1].x, slopes[2].x));
            let (wy, wz) = (weights[j].y, weights[k].z);
            sum += Vec4::new(
                value * wy * wz,
                slope * wy * wz,
                value * slopes[j].y * wz,
                value * wy * slopes[k].z,
            );
        }
    }
    (sum.x, inverse * sum.yzw())
}

/// The signed distance in m of a point from the nearest of some bodies, if one is nearer than `reach`.
#[inline]
pub(crate) fn nearest<'a>(
    bodies: impl Iterator<Item = &'a Body>,
    maps: &[Vec2],
    x: Vec3,
    reach: f32,
) -> Option<f32> {
    let distances = bodies.filter_map(|body| Some(at(body, maps, body.local(x), reach)?.distance));
    distances.filter(|distance| *distance < reach).reduce(f32::min)
}

/// The signed distance in m of a point inside a body, which is negative, and the unit normal of the nearest surface in the
/// world; `None` outside.
#[inline]
pub(crate) fn penetration(body: &Body, maps: &[Vec2], x: Vec3) -> Option<(f32, Vec3)> {
    if x.distance_squared(body.position) >= body.radius * body.radius {
        return None;
    }
    let field = at(body, maps, body.local(x), 0.0).filter(|field| field.distance < 0.0)?;
    let steepness = field.distance_gradient.length().max(1e-6);
    Some((field.distance, body.rotation() * (field.distance_gradient / steepness)))
}

/// The sum over boundary particles around a point of the mesh's frame: minus the gradient of their kernel fraction
/// (xyz), and the fraction (w). What lies outside the domain does not count.
pub(super) fn sampled<K: Kernel>(
    body: &Body,
    maps: &[Vec2],
    y: Vec3,
    support: f32,
    domain: &Interior,
) -> Vec4 {
    let scale = 1.0 / support;
    let scale3 = scale * scale * scale;
    let size = UVec3::new(body.samples_x, body.samples_y, body.samples_z).as_ivec3();
    let home = ((y - body.field_min) * scale).floor().as_ivec3();
    let (low, high) = ((home - 1).max(glam::IVec3::ZERO), (home + 1).min(size - 1));
    let mut sum = Vec4::ZERO;
    let rotation = body.rotation();
    // Boundary particles within the support of this point may lie outside.
    let is_cut = !domain.holds(body.position + rotation * (y - body.center), support);
    for z in low.z..=high.z {
        for row in low.y..=high.y {
            for x in low.x..=high.x {
                let cell = body.first_sample_cell as usize + ((z * size.y + row) * size.x + x) as usize;
                let range = maps[cell];
                for k in range.x.to_bits() as usize..range.y.to_bits() as usize {
                    let (xy, zv) = (maps[2 * k], maps[2 * k + 1]);
                    let d = y - xy.extend(zv.x);
                    let q = d.length() * scale;
                    if q < 1.0 {
                        let slope = -K::g(q) * scale * scale * d;
                        let mut volume = zv.y * scale3;
                        if is_cut {
                            let sample = xy.extend(zv.x) - body.center;
                            volume *= domain.part(body.position + rotation * sample);
                        }
                        sum += volume * slope.extend(K::w(q));
                    }
                }
            }
        }
    }
    sum
}
