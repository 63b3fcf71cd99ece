use std::marker::PhantomData;

use glam::{Vec2, Vec3, Vec4, Vec4Swizzles};
use splashdown_gpu::Scratch;

use super::SystemBindings;
use crate::boundary::{Images, Reflection, WallKernel, wall_friction};
use crate::kernel::Kernel;
use crate::pairs::{
    Link, ListedPair, ListedSum, NeighbourLists, Sorted, difference, dot, reflected, reflected_point, scaled,
    splat,
};
use crate::simd::Register;
use crate::state::Params;

pub(super) fn system<K: Kernel + WallKernel>(scratch: &mut Scratch, buffers: SystemBindings<'_>) {
    let SystemBindings {
        params,
        grid,
        state,
        cell_start,
        sorted_positions: positions,
        sorted_velocities: velocities,
        densities,
        accelerations,
        stiffness,
        ..
    } = buffers;
    let (support, scale) = (params.support_radius, 1.0 / params.support_radius);
    let volume = params.summed_mass / params.rest_density;
    let laminar = 10.0 * params.viscosity * volume;
    let images = Images::new(params);
    let pass = System::<K> {
        params,
        dt: state.dt,
        body: params.body_acceleration(state.time),
        images,
        positions,
        velocities,
        scale,
        scale5: (scale * scale) * (scale * scale) * scale,
        soft: 0.01 * support * support,
        separating: laminar,
        approaching: laminar + params.artificial_viscosity * params.sound_speed * 0.5 * support * volume,
        kernel: PhantomData,
    };
    let sorted = Sorted::new(support, grid, cell_start, positions).with_images(images);
    let outputs = ((densities, accelerations), stiffness);
    // The iterations use the lists.
    scratch.get::<NeighbourLists<K>>().make(sorted, outputs, &pass);
}

struct System<'a, K> {
    params: &'a Params,
    dt: f32,
    /// Acceleration by gravity and shaking.
    body: Vec3,
    images: Images,
    positions: &'a [Vec4],
    velocities: &'a [Vec4],
    scale: f32,
    scale5: f32,
    soft: f32,
    /// Viscosity factors of a pair that separates, and of one that approaches.
    separating: f32,
    approaching: f32,
    kernel: PhantomData<K>,
}

/// The sums: kernel, gradient, squares of the gradients, viscous acceleration.
impl<K: Kernel + WallKernel> ListedSum<7, 8> for System<'_, K> {
    type Output = ((Vec2, Vec4), Vec4);

    #[inline(always)]
    fn load(&self, j: usize) -> [f32; 7] {
        let (p, v) = (self.positions[j], self.velocities[j]);
        [p.x, p.y, p.z, v.x, v.y, v.z, Link::place_bits(j)]
    }

    #[inline(always)]
    fn pair<V: Register>(&self, i: usize) -> impl Fn([V; 7]) -> ListedPair<V, 8> {
        let (x, v) = (splat::<V>(self.positions[i]), splat::<V>(self.velocities[i]));
        let (zero, separating, approaching) =
            (V::splat(0.0), V::splat(self.separating), V::splat(self.approaching));
        #[inline(always)]
        move |[x_j, y_j, z_j, u_j, v_j, w_j, _]| {
            let d = difference(x, [x_j, y_j, z_j]);
            let r2 = dot(d, d);
            let q = r2.sqrt() * self.scale;
            let factor = K::g(q);
            let g = scaled(factor, d);
            let vx = dot(difference(v, [u_j, v_j, w_j]), d);
            let a = scaled(vx * vx.if_less(zero, approaching, separating) / (r2 + self.soft), g);
            let sums = [K::w(q), g[0], g[1], g[2], dot(g, g), a[0], a[1], a[2]];
            ListedPair { d, r2, factor, sums }
        }
    }

    #[inline(always)]
    fn reflect<V: Register>(&self, by: &Reflection, values: [V; 7]) -> [V; 7] {
        let [x, y, z, u, v, w, place] = values;
        let [x, y, z] = reflected_point(by, [x, y, z]);
        let [u, v, w] = reflected(by, [u, v, w]);
        [x, y, z, u, v, w, place]
    }

    #[inline(always)]
    fn finish(&self, i: usize, sums: [f32; 8]) -> Self::Output {
        let Self { params, scale, scale5, .. } = self;
        let [w, gx, gy, gz, squares, ax, ay, az] = sums;
        let (x, v) = (self.positions[i].xyz(), self.velocities[i].xyz());
        let factor = params.summed_mass / params.rest_density * scale5;
        let images = 1.0 + self.images.sides_near(x, params.support_radius) as f32 / 3.0;
        let density = Vec2::new(params.summed_mass * scale * scale * scale * w, 0.0);
        let other = self.body + wall_friction(params, K::WALLS, x, v, self.dt);
        let acceleration = scale5 * Vec3::new(ax, ay, az) + other;
        let stiffness = (factor * Vec3::new(gx, gy, gz)).extend(images * factor * factor * squares);
        ((density, acceleration.extend(0.0)), stiffness)
    }
}
