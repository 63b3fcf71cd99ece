use std::marker::PhantomData;

use glam::{Vec2, Vec3, Vec4, Vec4Swizzles};

use super::AccelerationBindings;
use crate::boundary::{Images, Reflection, WallKernel, part, wall_friction};
use crate::kernel::Kernel;
use crate::pairs::{
    self, PairSum, Sorted, difference, dot, extrapolated, reflected, reflected_point, scaled, splat,
};
use crate::passes::tension::Tension;
use crate::simd::Register;
use crate::state::{Params, StepState};

pub(super) fn acceleration<K: Kernel + WallKernel, const FORCES: u32>(buffers: AccelerationBindings<'_>) {
    let AccelerationBindings {
        params,
        grid,
        state,
        cell_start,
        sorted_positions: positions,
        sorted_velocities: velocities,
        densities,
        normals,
        accelerations,
    } = buffers;
    let pass = Acceleration::<K, FORCES>::new(params, state, positions, velocities, densities);
    let sorted =
        Sorted::new(params.support_radius, grid, cell_start, positions).with_images(Images::new(params));
    let out = accelerations;
    // Scenes without surface tension skip its columns and arithmetic.
    if FORCES & part::OTHER != 0 && params.surface_tension > 0.0 {
        pairs::for_each(sorted, out, &WithTension { forces: pass, normals });
    } else {
        pairs::for_each(sorted, out, &pass);
    }
}

/// Pressure, viscosity, walls and body forces, or the [`part`] `FORCES` of them.
pub(crate) struct Acceleration<'a, K, const FORCES: u32> {
    params: &'a Params,
    dt: f32,
    body: Vec3,
    positions: &'a [Vec4],
    velocities: &'a [Vec4],
    densities: &'a [Vec2],
    scale: f32,
    factor: f32,
    soft: f32,
    /// Viscosity factors of a pair that separates, and of one that approaches.
    separating: f32,
    approaching: f32,
    kernel: PhantomData<K>,
}

impl<'a, K: WallKernel, const FORCES: u32> Acceleration<'a, K, FORCES> {
    /// Uses the arrays of a step.
    pub fn new(
        params: &'a Params,
        state: &StepState,
        positions: &'a [Vec4],
        velocities: &'a [Vec4],
        densities: &'a [Vec2],
    ) -> Self {
        let (support, scale) = (params.support_radius, 1.0 / params.support_radius);
        let volume = params.summed_mass / params.rest_density;
        let laminar = 10.0 * params.viscosity * volume;
        Self {
            params,
            dt: state.dt,
            body: params.body_acceleration(state.time),
            positions,
            velocities,
            densities,
            scale,
            factor: (scale * scale) * (scale * scale) * scale,
            soft: 0.01 * support * support,
            separating: laminar,
            approaching: laminar + params.artificial_viscosity * params.sound_speed * 0.5 * support * volume,
            kernel: PhantomData,
        }
    }
}

impl<K: WallKernel, const FORCES: u32> Acceleration<'_, K, FORCES> {
    /// The acceleration of a particle from its sums.
    #[inline(always)]
    pub fn acceleration(&self, i: usize, sums: [f32; 3]) -> Vec3 {
        let a = self.factor * Vec3::from(sums);
        if FORCES & part::OTHER == 0 {
            return a;
        }
        let (x, v) = (self.positions[i].xyz(), self.velocities[i].xyz());
        a + self.body + wall_friction(self.params, K::WALLS, x, v, self.dt)
    }

    /// Mass times pressure over the square of the density.
    #[inline(always)]
    fn pressure_term(&self, j: usize) -> f32 {
        let [rho, pressure] = self.densities[j].to_array();
        self.params.summed_mass * pressure / (rho * rho)
    }
}

impl<K: Kernel + WallKernel, const FORCES: u32> PairSum<7, 3> for Acceleration<'_, K, FORCES> {
    type Output = Vec4;

    #[inline(always)]
    fn load(&self, j: usize) -> [f32; 7] {
        let (p, v) = (self.positions[j], self.velocities[j]);
        [p.x, p.y, p.z, v.x, v.y, v.z, self.pressure_term(j)]
    }

    /// The acceleration over the factor.
    #[inline(always)]
    fn pair<V: Register>(&self, i: usize) -> impl Fn([V; 7]) -> [V; 3] {
        let (x, v) = (splat::<V>(self.positions[i]), splat::<V>(self.velocities[i]));
        let pressure = V::splat(self.pressure_term(i));
        let (zero, separating, approaching) =
            (V::splat(0.0), V::splat(self.separating), V::splat(self.approaching));
        #[inline(always)]
        move |[x_j, y_j, z_j, u_j, v_j, w_j, pressure_j]| {
            let d = difference(x, [x_j, y_j, z_j]);
            let r2 = dot(d, d);
            let vx = dot(difference(v, [u_j, v_j, w_j]), d);
            let viscous = || vx * vx.if_less(zero, approaching, separating) / (r2 + self.soft);
            let along = match FORCES {
                part::PRESSURE => V::splat(0.0) - (pressure + pressure_j),
                part::OTHER => viscous(),
                _ => viscous() - (pressure + pressure_j),
            };
            scaled(K::g(r2.sqrt() * self.scale) * along, d)
        }
    }

    #[inline(always)]
    fn reflect<V: Register>(&self, by: &Reflection, values: [V; 7]) -> [V; 7] {
        let [x, y, z, u, v, w, pressure] = values;
        let image = reflected_point(by, [x, y, z]);
        let [u, v, w] = reflected(by, [u, v, w]);
        let gradient = self.params.summed_mass / self.params.rest_density * self.body;
        let more = dot(gradient.to_array().map(V::splat), difference(image, [x, y, z]));
        [image[0], image[1], image[2], u, v, w, extrapolated(pressure, more)]
    }

    #[inline(always)]
    fn finish(&self, i: usize, sums: [f32; 3]) -> Vec4 {
        self.acceleration(i, sums).extend(0.0)
    }
}

/// Pressure, viscosity and surface tension.
struct WithTension<'a, K, const FORCES: u32> {
    forces: Acceleration<'a, K, FORCES>,
    normals: &'a [Vec4],
}

impl<K: Kernel + WallKernel, const FORCES: u32> PairSum<11, 3> for WithTension<'_, K, FORCES> {
    type Output = Vec4;

    #[inline(always)]
    fn load(&self, j: usize) -> [f32; 11] {
        let [x, y, z, u, v, w, pressure] = self.forces.load(j);
        let n = self.normals[j];
        [x, y, z, u, v, w, pressure, self.forces.densities[j].x, n.x, n.y, n.z]
    }

    #[inline(always)]
    fn pair<V: Register>(&self, i: usize) -> impl Fn([V; 11]) -> [V; 3] {
        let Acceleration { params, positions, densities, factor, .. } = self.forces;
        let (x, n, rho) = (splat::<V>(positions[i]), splat::<V>(self.normals[i]), V::splat(densities[i].x));
        let tension = Tension::new(params);
        // `finish` multiplies the sums by the factor.
        let inverse = V::splat(1.0 / factor);
        let forces = self.forces.pair::<V>(i);
        #[inline(always)]
        move |[x_j, y_j, z_j, u_j, v_j, w_j, pressure_j, rho_j, n_x, n_y, n_z]| {
            let a = forces([x_j, y_j, z_j, u_j, v_j, w_j, pressure_j]);
            let d = difference(x, [x_j, y_j, z_j]);
            let n = difference(n, [n_x, n_y, n_z]);
            let t = scaled(inverse, tension.acceleration(d, dot(d, d).sqrt(), n, rho + rho_j));
            std::array::from_fn(|axis| a[axis] + t[axis])
        }
    }

    #[inline(always)]
    fn reflect<V: Register>(&self, by: &Reflection, values: [V; 11]) -> [V; 11] {
        let [x, y, z, u, v, w, pressure, rho, nx, ny, nz] = values;
        let [x, y, z, u, v, w, pressure] = self.forces.reflect(by, [x, y, z, u, v, w, pressure]);
        let [nx, ny, nz] = reflected(by, [nx, ny, nz]);
        [x, y, z, u, v, w, pressure, rho, nx, ny, nz]
    }

    #[inline(always)]
    fn finish(&self, i: usize, sums: [f32; 3]) -> Vec4 {
        self.forces.finish(i, sums)
    }
}
