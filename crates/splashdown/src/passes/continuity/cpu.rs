use std::marker::PhantomData;

use glam::{Vec2, Vec4};

use super::ContinuityBindings;
use crate::boundary::{Images, Reflection};
use crate::kernel::Kernel;
use crate::pairs::{self, PairSum, Sorted, difference, dot, reflected, reflected_point, splat};
use crate::simd::Register;
use crate::state::Params;

pub(super) fn continuity<K: Kernel>(buffers: ContinuityBindings<'_>) {
    let ContinuityBindings {
        params,
        grid,
        state,
        cell_start,
        sorted_positions: positions,
        sorted_velocities: velocities,
        densities,
    } = buffers;
    let scale = 1.0 / params.support_radius;
    let hydrostatic = params.rest_density / (params.sound_speed * params.sound_speed);
    let pass = Continuity::<K> {
        params,
        dt: state.dt,
        positions,
        velocities,
        scale,
        soft: 0.01 * params.support_radius * params.support_radius,
        diffusion: params.density_diffusion * params.support_radius * params.sound_speed,
        hydrostatic: (hydrostatic * params.body_acceleration(state.time)).extend(0.0),
        kernel: PhantomData,
    };
    let sorted =
        Sorted::new(params.support_radius, grid, cell_start, positions).with_images(Images::new(params));
    pairs::for_each(sorted, densities, &pass);
}

struct Continuity<'a, K> {
    params: &'a Params,
    dt: f32,
    positions: &'a [Vec4],
    /// The density is the fourth component.
    velocities: &'a [Vec4],
    scale: f32,
    soft: f32,
    diffusion: f32,
    /// The hydrostatic gradient of the density in kg/m^4.
    hydrostatic: Vec4,
    kernel: PhantomData<K>,
}

impl<K: Kernel> PairSum<8, 1> for Continuity<'_, K> {
    type Output = Vec2;

    #[inline(always)]
    fn load(&self, j: usize) -> [f32; 8] {
        let (p, v, scale) = (self.positions[j], self.velocities[j], self.scale);
        let weight = self.params.summed_mass * (scale * scale) * (scale * scale) * scale / v.w;
        [p.x, p.y, p.z, v.x, v.y, v.z, v.w, weight]
    }

    #[inline(always)]
    fn pair<V: Register>(&self, i: usize) -> impl Fn([V; 8]) -> [V; 1] {
        let (x, v) = (splat::<V>(self.positions[i]), splat::<V>(self.velocities[i]));
        let (rho, hydrostatic) = (V::splat(self.velocities[i].w), splat::<V>(self.hydrostatic));
        let diffusion = V::splat(self.diffusion);
        #[inline(always)]
        move |[x_j, y_j, z_j, u_j, v_j, w_j, rho_j, weight]| {
            let d = difference(x, [x_j, y_j, z_j]);
            let r2 = dot(d, d);
            let vx = dot(difference(v, [u_j, v_j, w_j]), d);
            let psi = rho_j - rho + dot(hydrostatic, d);
            let flow = rho * vx - diffusion * psi * (r2 / (r2 + self.soft));
            [K::g(r2.sqrt() * self.scale) * weight * flow]
        }
    }

    /// The density of an image continues hydrostatically.
    #[inline(always)]
    fn reflect<V: Register>(&self, by: &Reflection, values: [V; 8]) -> [V; 8] {
        let [x, y, z, u, v, w, rho, weight] = values;
        let [xi, yi, zi] = reflected_point(by, [x, y, z]);
        let [ui, vi, wi] = reflected(by, [u, v, w]);
        let more = dot(splat::<V>(self.hydrostatic), difference([xi, yi, zi], [x, y, z]));
        [xi, yi, zi, ui, vi, wi, rho + more, weight]
    }

    #[inline(always)]
    fn finish(&self, i: usize, [sum]: [f32; 1], out: &mut Vec2) {
        let next = self.velocities[i].w + self.dt * sum;
        *out = Vec2::new(next, self.params.pressure_at(next));
    }
}
