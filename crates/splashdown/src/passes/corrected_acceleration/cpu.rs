use std::marker::PhantomData;

use glam::{Vec2, Vec3, Vec4, Vec4Swizzles};

use super::CorrectedAccelerationBindings;
use crate::boundary::{Images, Reflection, WallKernel, wall_friction};
use crate::kernel::Kernel;
use crate::pairs::{
    self, PairSum, Sorted, difference, dot, extrapolated, reflected, reflected_point, scaled, splat,
};
use crate::passes::tension::Tension;
use crate::simd::Register;
use crate::state::{Params, StepState, Symmetric};

pub(super) fn corrected_acceleration<K: Kernel + WallKernel>(buffers: CorrectedAccelerationBindings<'_>) {
    let CorrectedAccelerationBindings {
        params,
        grid,
        state,
        cell_start,
        sorted_positions: positions,
        sorted_velocities: velocities,
        densities,
        corrections,
        normals,
        accelerations,
        shifts,
    } = buffers;
    let corrections = corrections.as_chunks::<2>().0;
    let pass = Corrected::<K>::new(params, state, positions, velocities, densities, corrections);
    let sorted =
        Sorted::new(params.support_radius, grid, cell_start, positions).with_images(Images::new(params));
    let outputs = (accelerations, shifts);
    if params.surface_tension > 0.0 {
        pairs::for_each(sorted, outputs, &WithTension { forces: pass, normals });
    } else {
        pairs::for_each(sorted, outputs, &pass);
    }
}

/// Pressure, viscosity, walls and body forces, and the shifting.
struct Corrected<'a, K> {
    params: &'a Params,
    dt: f32,
    body: Vec3,
    positions: &'a [Vec4],
    velocities: &'a [Vec4],
    densities: &'a [Vec2],
    /// The matrix B and the coefficient of the shifting: see `continuity`.
    corrections: &'a [[Vec4; 2]],
    /// One over the support radius.
    scale: f32,
    /// The fifth power of the scale.
    factor: f32,
    soft: f32,
    laminar: f32,
    /// Factor of the artificial viscosity and a speed.
    artificial: f32,
    /// The part of this speed that does not depend on the approach.
    artificial_speed: f32,
    kernel: PhantomData<K>,
}

impl<'a, K> Corrected<'a, K> {
    fn new(
        params: &'a Params,
        state: &StepState,
        positions: &'a [Vec4],
        velocities: &'a [Vec4],
        densities: &'a [Vec2],
        corrections: &'a [[Vec4; 2]],
    ) -> Self {
        let (support, scale) = (params.support_radius, 1.0 / params.support_radius);
        let volume = params.summed_mass / params.rest_density;
        Self {
            params,
            dt: state.dt,
            body: params.body_acceleration(state.time),
            positions,
            velocities,
            densities,
            corrections,
            scale,
            factor: (scale * scale) * (scale * scale) * scale,
            soft: 0.01 * support * support,
            laminar: 10.0 * params.viscosity * volume,
            artificial: 0.5 * support * volume,
            artificial_speed: params.artificial_viscosity * params.sound_speed,
            kernel: PhantomData,
        }
    }

    /// Mass times pressure over the square of the density.
    #[inline(always)]
    fn pressure_term(&self, j: usize) -> f32 {
        let [rho, pressure] = self.densities[j].to_array();
        self.params.summed_mass * pressure / (rho * rho)
    }
}

/// The sums: the acceleration over the factor, and the gradient of the concentration.
impl<K: Kernel + WallKernel> PairSum<13, 6> for Corrected<'_, K> {
    type Output = (Vec4, Vec4);

    #[inline(always)]
    fn load(&self, j: usize) -> [f32; 13] {
        let (p, v) = (self.positions[j], self.velocities[j]);
        let [xx, yy, zz, xy, xz, yz] = Symmetric::from_vectors(self.corrections[j]).to_array();
        [p.x, p.y, p.z, v.x, v.y, v.z, self.pressure_term(j), xx, yy, zz, xy, xz, yz]
    }

    #[inline(always)]
    fn pair<V: Register>(&self, i: usize) -> impl Fn([V; 13]) -> [V; 6] {
        let (x, v) = (splat::<V>(self.positions[i]), splat::<V>(self.velocities[i]));
        let pressure = self.pressure_term(i);
        let own = Symmetric::from_vectors(self.corrections[i]).to_array().map(|b| V::splat(pressure * b));
        let (zero, one) = (V::splat(0.0), V::splat(1.0));
        let sound_speed = V::splat(self.params.sound_speed);
        #[inline(always)]
        move |[x_j, y_j, z_j, u_j, v_j, w_j, pressure_j, xx, yy, zz, xy, xz, yz]| {
            let d = difference(x, [x_j, y_j, z_j]);
            let r2 = dot(d, d);
            let r = r2.sqrt();
            let q = r * self.scale;
            let g = K::g(q);
            let vx = dot(difference(v, [u_j, v_j, w_j]), d);
            let inverse = one / (r2 + self.soft);
            let approach = vx * r * inverse * -3.0;
            let approach = approach.if_less(sound_speed, approach, sound_speed) + self.artificial_speed;
            let speed = vx.if_less(zero, approach * self.artificial, zero);
            let viscous = vx * (speed + self.laminar) * inverse;
            let (xx, yy, zz) = (own[0] + pressure_j * xx, own[1] + pressure_j * yy, own[2] + pressure_j * zz);
            let (xy, xz, yz) = (own[3] + pressure_j * xy, own[4] + pressure_j * xz, own[5] + pressure_j * yz);
            let a = [
                viscous * d[0] - (xx * d[0] + xy * d[1] + xz * d[2]),
                viscous * d[1] - (xy * d[0] + yy * d[1] + yz * d[2]),
                viscous * d[2] - (xz * d[0] + yz * d[1] + zz * d[2]),
            ];
            let [a, b, c] = scaled(g, a);
            let near = K::w(q) * self.params.inverse_kernel_at_spacing;
            let near2 = near * near;
            let [l, m, n] = scaled(g * (one + near2 * near2 * 0.2), d);
            [a, b, c, l, m, n]
        }
    }

    #[inline(always)]
    fn reflect<V: Register>(&self, by: &Reflection, values: [V; 13]) -> [V; 13] {
        let [x, y, z, u, v, w, pressure, xx, yy, zz, xy, xz, yz] = values;
        let image = reflected_point(by, [x, y, z]);
        let [u, v, w] = reflected(by, [u, v, w]);
        let gradient = self.params.summed_mass / self.params.rest_density * self.body;
        let more = dot(gradient.to_array().map(V::splat), difference(image, [x, y, z]));
        let sign = by.sign;
        let (xy, xz, yz) = (xy * (sign.x * sign.y), xz * (sign.x * sign.z), yz * (sign.y * sign.z));
        [image[0], image[1], image[2], u, v, w, extrapolated(pressure, more), xx, yy, zz, xy, xz, yz]
    }

    #[inline(always)]
    fn finish(&self, i: usize, [a, b, c, l, m, n]: [f32; 6]) -> (Vec4, Vec4) {
        let (params, [correction, _]) = (self.params, self.corrections[i]);
        let (x, v) = (self.positions[i].xyz(), self.velocities[i].xyz());
        let acceleration =
            self.factor * Vec3::new(a, b, c) + self.body + wall_friction(params, K::WALLS, x, v, self.dt);
        let volume = params.summed_mass / params.rest_density;
        let shift = -correction.w * volume * self.factor * Vec3::new(l, m, n);
        (acceleration.extend(0.0), shift.extend(self.densities[i].x))
    }
}

/// As [`Corrected`], and surface tension.
struct WithTension<'a, K> {
    forces: Corrected<'a, K>,
    normals: &'a [Vec4],
}

impl<K: Kernel + WallKernel> PairSum<17, 6> for WithTension<'_, K> {
    type Output = (Vec4, Vec4);

    #[inline(always)]
    fn load(&self, j: usize) -> [f32; 17] {
        let mut values = [0.0; 17];
        values[..13].copy_from_slice(&self.forces.load(j));
        let n = self.normals[j];
        values[13..].copy_from_slice(&[self.forces.densities[j].x, n.x, n.y, n.z]);
        values
    }

    #[inline(always)]
    fn pair<V: Register>(&self, i: usize) -> impl Fn([V; 17]) -> [V; 6] {
        let Corrected { params, positions, densities, factor, .. } = self.forces;
        let (x, n, rho) = (splat::<V>(positions[i]), splat::<V>(self.normals[i]), V::splat(densities[i].x));
        let tension = Tension::new(params);
        // `finish` multiplies the sums by the factor.
        let inverse = V::splat(1.0 / factor);
        let forces = self.forces.pair::<V>(i);
        #[inline(always)]
        move |values| {
            let [a, b, c, l, m, k] = forces(std::array::from_fn(|column| values[column]));
            let d = difference(x, [values[0], values[1], values[2]]);
            let n = difference(n, [values[14], values[15], values[16]]);
            let t = scaled(inverse, tension.acceleration(d, dot(d, d).sqrt(), n, rho + values[13]));
            [a + t[0], b + t[1], c + t[2], l, m, k]
        }
    }

    #[inline(always)]
    fn reflect<V: Register>(&self, by: &Reflection, values: [V; 17]) -> [V; 17] {
        let forces = self.forces.reflect(by, std::array::from_fn(|column| values[column]));
        let normal = reflected(by, [values[14], values[15], values[16]]);
        std::array::from_fn(|column| match column {
            0..13 => forces[column],
            13 => values[13],
            _ => normal[column - 14],
        })
    }

    #[inline(always)]
    fn finish(&self, i: usize, sums: [f32; 6]) -> (Vec4, Vec4) {
        self.forces.finish(i, sums)
    }
}
