use std::marker::PhantomData;

use glam::{Vec2, Vec4, Vec4Swizzles};

use super::ContinuityBindings;
use crate::boundary::{NearWalls, WallKernel};
use crate::kernel::Kernel;
use crate::pairs::{self, PairSum, Sorted, difference, dot, splat};
use crate::simd::Register;
use crate::state::Params;

pub(super) fn continuity<K: Kernel + WallKernel>(buffers: ContinuityBindings<'_>) {
    let ContinuityBindings {
        params,
        grid,
        state,
        cell_start,
        sorted_positions: positions,
        sorted_velocities: velocities,
        wall_table,
        densities,
    } = buffers;
    let scale = 1.0 / params.support_radius;
    let hydrostatic = params.rest_density / (params.sound_speed * params.sound_speed);
    let pass = Continuity::<K> {
        params,
        dt: state.dt,
        positions,
        velocities,
        walls: NearWalls::new(params.walls(K::WALLS), wall_table),
        scale,
        soft: 0.01 * params.support_radius * params.support_radius,
        diffusion: params.density_diffusion * params.support_radius * params.sound_speed,
        hydrostatic: (hydrostatic * params.body_acceleration(state.time)).extend(0.0),
        kernel: PhantomData,
    };
    let sorted = Sorted::new(params.support_radius, grid, cell_start, positions);
    pairs::for_each(sorted, densities, &pass);
}

struct Continuity<'a, K> {
    params: &'a Params,
    dt: f32,
    positions: &'a [Vec4],
    /// The density is the fourth component.
    velocities: &'a [Vec4],
    walls: NearWalls<'a>,
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
        let weight = self.params.particle_mass * (scale * scale) * (scale * scale) * scale / v.w;
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

    #[inline(always)]
    fn finish(&self, i: usize, [sum]: [f32; 1], out: &mut Vec2) {
        let (x, v) = (self.positions[i].xyz(), self.velocities[i]);
        let mut rate = sum;
        if let Some(terms) = self.walls.terms(x) {
            rate -= 2.0 * v.w * self.scale * (terms.slope * terms.normal).dot(v.xyz());
        }
        let next = v.w + self.dt * rate;
        *out = Vec2::new(next, self.params.pressure_at(next));
    }
}
