use glam::{Vec3, Vec4, Vec4Swizzles};
use rayon::prelude::*;

use super::super::pair::Law;
use super::super::{GROUP, GROUPS};
use super::ProductBindings;
use crate::boundary::{Images, Reflection};
use crate::pairs::{self, Outputs, PairSum, Sorted, difference, reflected, reflected_point, splat};
use crate::simd::Register;
use crate::state::Params;

pub(super) fn product<const BODIES: bool>(buffers: ProductBindings<'_>) {
    let ProductBindings {
        params,
        grid,
        state,
        viscous,
        cell_start,
        sorted_positions: positions,
        viscous_residuals,
        viscous_products,
        residuals,
    } = buffers;
    if viscous.stopped != 0 {
        return;
    }
    let sorted =
        Sorted::new(params.support_radius, grid, cell_start, positions).with_images(Images::new(params));
    let n = sorted.active_count();
    let (rate, images) = (state.dt * params.viscous_factor, Images::new(params));
    let pass = Product { params, rate, images, positions, residuals: viscous_residuals };
    // Without friction an image needs no more columns than a particle, and far from walls there are none.
    pairs::for_each(sorted, Stored::<BODIES>(viscous_products), &Slipping(pass));
    if params.wall_friction != 0.0 {
        pairs::for_each(sorted, Stored::<BODIES>(viscous_products), &pass);
    }
    let products = &viscous_products[..n];
    let tasks = products.par_chunks(GROUP * GROUPS).zip(residuals.par_chunks_mut(GROUPS));
    tasks.enumerate().for_each(|(task, (products, sums))| {
        for (group, (products, sum)) in products.chunks(GROUP).zip(sums).enumerate() {
            let first = (task * GROUPS + group) * GROUP;
            let terms = |(k, w): (usize, &Vec4)| {
                let r = viscous_residuals[first + k];
                if r.w == 0.0 {
                    return Vec4::ZERO;
                }
                let (r, z) = (r.xyz(), r.w * r.xyz());
                Vec4::new(r.dot(z), z.dot(w.xyz()), r.length_squared(), z.length_squared())
            };
            *sum = products.iter().enumerate().map(terms).sum();
        }
    });
}

/// Stores the results of the particles that a pass is for, or adds them to what is there.
struct Stored<'a, const ADDS: bool>(&'a mut [Vec4]);

impl<const ADDS: bool> Outputs<Option<Vec4>> for Stored<'_, ADDS> {
    fn split_at(self, middle: usize) -> (Self, Self) {
        let (first, second) = self.0.split_at_mut(middle);
        (Self(first), Self(second))
    }

    #[inline(always)]
    fn put(&mut self, i: usize, value: Option<Vec4>) {
        if let Some(value) = value {
            self.0[i] = if ADDS { self.0[i] + value } else { value };
        }
    }
}

#[derive(Clone, Copy)]
struct Product<'a> {
    params: &'a Params,
    /// Factor of the sums.
    rate: f32,
    images: Images,
    positions: &'a [Vec4],
    residuals: &'a [Vec4],
}

impl Product<'_> {
    /// The preconditioned residual.
    #[inline(always)]
    fn preconditioned(&self, j: usize) -> Vec4 {
        let r = self.residuals[j];
        (r.w * r.xyz()).extend(0.0)
    }

    #[inline(always)]
    fn finished(&self, i: usize, sums: [f32; 3]) -> Vec4 {
        if self.is_driven(i) {
            return Vec4::ZERO;
        }
        (self.preconditioned(i).xyz() + self.rate * Vec3::from(sums)).extend(0.0)
    }

    /// True if the friction of walls acts on a particle.
    #[inline(always)]
    fn has_friction(&self, i: usize) -> bool {
        self.params.wall_friction != 0.0
            && self.images.sides_near(self.positions[i].xyz(), self.params.support_radius) > 0
    }

    /// True where a nozzle determines the motion.
    #[inline(always)]
    fn is_driven(&self, i: usize) -> bool {
        self.residuals[i].w == 0.0
    }
}

/// Near walls with friction. The last columns are the signs of the reflection.
impl PairSum<9, 3> for Product<'_> {
    type Output = Option<Vec4>;

    #[inline(always)]
    fn load(&self, j: usize) -> [f32; 9] {
        let (p, z) = (self.positions[j], self.preconditioned(j));
        [p.x, p.y, p.z, z.x, z.y, z.z, 1.0, 1.0, 1.0]
    }

    #[inline(always)]
    fn pair<V: Register>(&self, i: usize) -> impl Fn([V; 9]) -> [V; 3] {
        let (x, z) = (splat::<V>(self.positions[i]), splat::<V>(self.preconditioned(i)));
        let law = Law::<V>::new(self.params.support_radius, self.params.wall_friction);
        #[inline(always)]
        move |[x_j, y_j, z_j, u, v, w, a, b, c]| {
            law.with_friction(z, [u, v, w], difference(x, [x_j, y_j, z_j]), [a, b, c])
        }
    }

    #[inline(always)]
    fn reflect<V: Register>(&self, by: &Reflection, values: [V; 9]) -> [V; 9] {
        let [x, y, z, u, v, w, a, b, c] = values;
        let [x, y, z] = reflected_point(by, [x, y, z]);
        let [e, f, g] = by.sign.to_array().map(V::splat);
        [x, y, z, u, v, w, a * e, b * f, c * g]
    }

    #[inline(always)]
    fn finish(&self, i: usize, sums: [f32; 3]) -> Option<Vec4> {
        self.has_friction(i).then(|| self.finished(i, sums))
    }

    #[inline(always)]
    fn wants(&self, i: usize) -> bool {
        self.has_friction(i) && !self.is_driven(i)
    }
}

/// Far from walls, or without their friction.
struct Slipping<'a>(Product<'a>);

impl PairSum<6, 3> for Slipping<'_> {
    type Output = Option<Vec4>;

    #[inline(always)]
    fn load(&self, j: usize) -> [f32; 6] {
        let (p, z) = (self.0.positions[j], self.0.preconditioned(j));
        [p.x, p.y, p.z, z.x, z.y, z.z]
    }

    #[inline(always)]
    fn pair<V: Register>(&self, i: usize) -> impl Fn([V; 6]) -> [V; 3] {
        let (x, z) = (splat::<V>(self.0.positions[i]), splat::<V>(self.0.preconditioned(i)));
        let law = Law::<V>::new(self.0.params.support_radius, 0.0);
        #[inline(always)]
        move |[x_j, y_j, z_j, u, v, w]| law.slipping(z, [u, v, w], difference(x, [x_j, y_j, z_j]))
    }

    #[inline(always)]
    fn reflect<V: Register>(&self, by: &Reflection, values: [V; 6]) -> [V; 6] {
        let [x, y, z, u, v, w] = values;
        let [x, y, z] = reflected_point(by, [x, y, z]);
        let [u, v, w] = reflected(by, [u, v, w]);
        [x, y, z, u, v, w]
    }

    #[inline(always)]
    fn finish(&self, i: usize, sums: [f32; 3]) -> Option<Vec4> {
        (!self.0.has_friction(i)).then(|| self.0.finished(i, sums))
    }

    #[inline(always)]
    fn wants(&self, i: usize) -> bool {
        !self.0.is_driven(i) && !self.0.has_friction(i)
    }
}
