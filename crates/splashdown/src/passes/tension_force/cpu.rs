use std::marker::PhantomData;

use glam::{Vec3, Vec4, Vec4Swizzles};

use super::{CLOSE, REPULSION, TensionForceBindings};
use crate::boundary::{Images, Reflection};
use crate::kernel::Kernel;
use crate::pairs::{
    self, Added, PairSum, Sorted, difference, dot, reflected, reflected_point, scaled, splat,
};
use crate::simd::Register;
use crate::state::{Params, Symmetric};

/// Balances a pressure force with corrected gradients if `CORRECTED`, otherwise one with plain gradients.
pub(super) fn tension_force<K: Kernel, const CORRECTED: bool>(buffers: TensionForceBindings<'_>) {
    let TensionForceBindings {
        params,
        grid,
        cell_start,
        sorted_positions: positions,
        normals,
        smooth_normals,
        corrections,
        accelerations,
    } = buffers;
    let pass = TensionForce::<K, CORRECTED> {
        params,
        positions,
        normals,
        smooth_normals,
        corrections: corrections.as_chunks::<2>().0,
        images: Images::new(params),
        scale: 1.0 / params.support_radius,
        repulsion: if params.is_implicit == 1 { REPULSION } else { 0.0 },
        kernel: PhantomData,
    };
    let sorted =
        Sorted::new(params.support_radius, grid, cell_start, positions).with_images(Images::new(params));
    pairs::for_each(sorted, Added(accelerations), &pass);
}

struct TensionForce<'a, K, const CORRECTED: bool> {
    params: &'a Params,
    positions: &'a [Vec4],
    normals: &'a [Vec4],
    smooth_normals: &'a [Vec4],
    corrections: &'a [[Vec4; 2]],
    images: Images,
    scale: f32,
    /// The strength of the repulsion of close particles at a distance of zero.
    repulsion: f32,
    kernel: PhantomData<K>,
}

impl<K, const CORRECTED: bool> TensionForce<'_, K, CORRECTED> {
    /// The weight of a normal: 0 where it is too short to have a direction, 1 at the surface.
    #[inline(always)]
    fn weight(&self, normal: Vec4) -> f32 {
        let weakest = self.params.weakest_normal;
        ((normal.xyz().length() - weakest) / (1.5 * weakest)).clamp(0.0, 1.0)
    }

    /// The smooth normal as a unit vector.
    #[inline(always)]
    fn direction(&self, j: usize) -> Vec3 {
        let n = self.smooth_normals[j].xyz();
        n / n.length().max(1e-12)
    }

    #[inline(always)]
    fn correction(&self, j: usize) -> [f32; 6] {
        if CORRECTED {
            Symmetric::from_vectors(self.corrections[j]).to_array()
        } else {
            [1.0, 1.0, 1.0, 0.0, 0.0, 0.0]
        }
    }
}

/// The sums: numerator and denominator of the curvature, the gradient of a uniform pressure, and the part of it by close
/// neighbours.
impl<K: Kernel, const CORRECTED: bool> PairSum<13, 8> for TensionForce<'_, K, CORRECTED> {
    type Output = Vec4;

    #[inline(always)]
    fn load(&self, j: usize) -> [f32; 13] {
        let (p, weight) = (self.positions[j], self.weight(self.smooth_normals[j]));
        let u = self.direction(j);
        let [xx, yy, zz, xy, xz, yz] = self.correction(j);
        [p.x, p.y, p.z, u.x, u.y, u.z, weight, xx, yy, zz, xy, xz, yz]
    }

    #[inline(always)]
    fn pair<V: Register>(&self, i: usize) -> impl Fn([V; 13]) -> [V; 8] {
        let (x, u) = (splat::<V>(self.positions[i]), self.direction(i).to_array().map(V::splat));
        let own = self.correction(i).map(V::splat);
        let one = V::splat(1.0);
        #[inline(always)]
        move |[x_j, y_j, z_j, a, b, c, weight, xx, yy, zz, xy, xz, yz]| {
            let d = difference(x, [x_j, y_j, z_j]);
            let r2 = dot(d, d);
            let q = r2.sqrt() * self.scale;
            let g = K::g(q);
            let closeness = (one - q * (1.0 / CLOSE)).max(V::splat(0.0));
            let along = dot(d, u);
            let (xx, yy, zz) = (own[0] + xx, own[1] + yy, own[2] + zz);
            let (xy, xz, yz) = (own[3] + xy, own[4] + xz, own[5] + yz);
            let gradient = [
                xx * d[0] + xy * d[1] + xz * d[2],
                xy * d[0] + yy * d[1] + yz * d[2],
                xz * d[0] + yz * d[1] + zz * d[2],
            ];
            let ([l, m, n], close) = (scaled(g, gradient), scaled(g * closeness, gradient));
            let weighted = g * weight;
            let turn = weighted * dot(difference([a, b, c], u), d);
            [turn, weighted * (r2 - along * along), l, m, n, close[0], close[1], close[2]]
        }
    }

    #[inline(always)]
    fn reflect<V: Register>(&self, by: &Reflection, values: [V; 13]) -> [V; 13] {
        let [x, y, z, a, b, c, weight, xx, yy, zz, xy, xz, yz] = values;
        let ([x, y, z], [a, b, c]) = (reflected_point(by, [x, y, z]), reflected(by, [a, b, c]));
        let sign = by.sign;
        let (xy, xz, yz) = (xy * (sign.x * sign.y), xz * (sign.x * sign.z), yz * (sign.y * sign.z));
        [x, y, z, a, b, c, weight, xx, yy, zz, xy, xz, yz]
    }

    fn wants(&self, i: usize) -> bool {
        self.weight(self.normals[i]) > 0.0
    }

    #[inline(always)]
    fn finish(&self, i: usize, [turn, extent, a, b, c, close_x, close_y, close_z]: [f32; 8]) -> Vec4 {
        let params = self.params;
        let (limit, reach) = (params.largest_curvature, params.support_radius * params.support_radius);
        let inner = (2.0 * turn / extent.min(-1e-3 * reach)).clamp(-limit, limit);
        let curvature = inner / (1.0 + 0.5 * params.interface_depth * inner).max(0.25);
        let strength = params.tension_factor * self.weight(self.normals[i]);
        // The force of each side acts along it.
        let [low, high] = self.images.nearness(self.positions[i].xyz(), params.support_radius);
        let near = params.wetting * (low + high);
        let along = near - Vec3::splat(near.element_sum());
        let repulsion = self.repulsion * curvature.abs() * Vec3::new(close_x, close_y, close_z);
        (strength * ((Vec3::splat(curvature) + along) * Vec3::new(a, b, c) - repulsion)).extend(0.0)
    }
}
