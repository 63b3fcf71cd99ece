use glam::{Vec2, Vec3, Vec4, Vec4Swizzles};

use super::MuellerBindings;
use crate::boundary::{Images, KernelPair, Reflection, wall_friction};
use crate::kernel::{Kernel, Poly6, Spiky, viscosity_laplacian};
use crate::pairs::{self, PairSum, Sorted, difference, dot, extrapolated, reflected, reflected_point, splat};
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
        accelerations,
    } = buffers;
    let pass = Mueller {
        params,
        dt: state.dt,
        body: params.body_acceleration(state.time),
        positions,
        velocities,
        densities,
        scale: 1.0 / params.support_radius,
    };
    let sorted =
        Sorted::new(params.support_radius, grid, cell_start, positions).with_images(Images::new(params));
    pairs::for_each(sorted, accelerations, &pass);
}

struct Mueller<'a> {
    params: &'a Params,
    dt: f32,
    body: Vec3,
    positions: &'a [Vec4],
    velocities: &'a [Vec4],
    densities: &'a [Vec2],
    scale: f32,
}

impl PairSum<8, 7> for Mueller<'_> {
    type Output = Vec4;

    #[inline(always)]
    fn load(&self, j: usize) -> [f32; 8] {
        let (p, v, [rho, pressure]) = (self.positions[j], self.velocities[j], self.densities[j].to_array());
        [p.x, p.y, p.z, v.x, v.y, v.z, pressure, self.params.summed_mass / rho]
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
    fn reflect<V: Register>(&self, by: &Reflection, values: [V; 8]) -> [V; 8] {
        let [x, y, z, u, v, w, pressure, volume] = values;
        let image = reflected_point(by, [x, y, z]);
        let [u, v, w] = reflected(by, [u, v, w]);
        let gradient = (self.params.rest_density * self.body).to_array().map(V::splat);
        let more = dot(gradient, difference(image, [x, y, z]));
        [image[0], image[1], image[2], u, v, w, extrapolated(pressure, more), volume]
    }

    #[inline(always)]
    fn finish(&self, i: usize, sums: [f32; 7]) -> Vec4 {
        let (params, scale) = (self.params, self.scale);
        let (x, v, rho) = (self.positions[i].xyz(), self.velocities[i].xyz(), self.densities[i].x);
        let scale5 = (scale * scale) * (scale * scale) * scale;
        let [fx, fy, fz, nx, ny, nz, laplacian] = sums.map(|sum| scale5 * sum);
        let (mut force, normal) = (Vec3::new(fx, fy, fz), Vec3::new(nx, ny, nz));
        let steepness = normal.length();
        if steepness > 0.5 * scale {
            force -= params.surface_tension * laplacian / steepness * normal;
        }
        let friction = wall_friction(params, KernelPair::Mueller, x, v, self.dt);
        (force / rho + friction + self.body).extend(0.0)
    }
}
