use glam::{Vec2, Vec3, Vec4, Vec4Swizzles};

use super::MuellerBindings;
use crate::boundary::{KernelPair, NearWalls, part};
use crate::kernel::{Kernel, Poly6, Spiky, viscosity_laplacian};
use crate::pairs::{self, PairSum, Sorted, difference, dot, splat};
use crate::simd::Register;
use crate::state::Params;

pub(super) fn mueller(buffers: MuellerBindings<'_>) {
    let MuellerBindings {
        params,
        grid,
        state,
        cell_start,
        sorted_positions: positions,
        sorted_velocities: velocities,
        densities,
        wall_table,
        accelerations,
    } = buffers;
    let pass = Mueller {
        params,
        dt: state.dt,
        body: params.body_acceleration(state.time),
        positions,
        velocities,
        densities,
        walls: NearWalls::new(params.walls(KernelPair::Mueller), wall_table),
        scale: 1.0 / params.support_radius,
    };
    pairs::for_each(Sorted::new(params.support_radius, grid, cell_start, positions), accelerations, &pass);
}

struct Mueller<'a> {
    params: &'a Params,
    dt: f32,
    body: Vec3,
    positions: &'a [Vec4],
    velocities: &'a [Vec4],
    densities: &'a [Vec2],
    walls: NearWalls<'a>,
    scale: f32,
}

impl PairSum<8, 7> for Mueller<'_> {
    type Output = Vec4;

    #[inline(always)]
    fn load(&self, j: usize) -> [f32; 8] {
        let (p, v, [rho, pressure]) = (self.positions[j], self.velocities[j], self.densities[j].to_array());
        [p.x, p.y, p.z, v.x, v.y, v.z, pressure, self.params.particle_mass / rho]
    }

    /// Pressure and viscosity; the gradient of the colour field and its Laplacian.
    #[inline(always)]
    fn pair<V: Register>(&self, i: usize) -> impl Fn([V; 8]) -> [V; 7] {
        let (x, v) = (splat::<V>(self.positions[i]), splat::<V>(self.velocities[i]));
        let pressure = V::splat(self.densities[i].y);
        let friction = self.params.viscosity * self.params.rest_density;
        #[inline(always)]
        move |[x_j, y_j, z_j, u_j, v_j, w_j, pressure_j, volume]| {
            let d = difference(x, [x_j, y_j, z_j]);
            let q = dot(d, d).sqrt() * self.scale;
            let pressure_force = volume * (pressure + pressure_j) * Spiky::g(q) * -0.5;
            let viscous_force = volume * viscosity_laplacian(q) * friction;
            let slope = volume * Poly6::g(q);
            let dv = difference([u_j, v_j, w_j], v);
            [
                pressure_force * d[0] + viscous_force * dv[0],
                pressure_force * d[1] + viscous_force * dv[1],
                pressure_force * d[2] + viscous_force * dv[2],
                slope * d[0],
                slope * d[1],
                slope * d[2],
                volume * Poly6::laplacian(q),
            ]
        }
    }

    #[inline(always)]
    fn finish(&self, i: usize, sums: [f32; 7], out: &mut Vec4) {
        let (params, scale) = (self.params, self.scale);
        let (x, v, [rho, pressure]) =
            (self.positions[i].xyz(), self.velocities[i].xyz(), self.densities[i].to_array());
        let scale5 = (scale * scale) * (scale * scale) * scale;
        let [fx, fy, fz, nx, ny, nz, laplacian] = sums.map(|sum| scale5 * sum);
        let (mut force, normal) = (Vec3::new(fx, fy, fz), Vec3::new(nx, ny, nz));
        let steepness = normal.length();
        if steepness > 0.5 * scale {
            force -= params.surface_tension * laplacian / steepness * normal;
        }
        let mut a = force / rho;
        if let Some(terms) = self.walls.terms(x) {
            a = terms.acceleration::<{ part::ALL }>(params, v, self.body, a, pressure / rho, self.dt);
        }
        *out = (a + self.body).extend(0.0);
    }
}
