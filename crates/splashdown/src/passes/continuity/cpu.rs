use std::marker::PhantomData;

use glam::{Vec2, Vec3, Vec4};

use super::ContinuityBindings;
use crate::boundary::{Images, Reflection};
use crate::kernel::Kernel;
use crate::pairs::{self, PairSum, Sorted, difference, dot, reflected, reflected_point, scaled, splat};
use crate::passes::correction::{correction, rest_strain, shifting, volume_recovery, without_tension};
use crate::simd::Register;
use crate::state::{Params, Symmetric};

pub(super) fn continuity<K: Kernel, const BODIES: bool>(buffers: ContinuityBindings<'_>) {
    let ContinuityBindings {
        params,
        grid,
        state,
        cell_start,
        sorted_positions: positions,
        sorted_velocities: velocities,
        boundary_matrices,
        densities,
        corrections,
    } = buffers;
    let scale = 1.0 / params.support_radius;
    let hydrostatic = params.rest_density / (params.sound_speed * params.sound_speed);
    let pass = Continuity::<K, BODIES> {
        params,
        dt: state.dt,
        positions,
        velocities,
        boundary: boundary_matrices.as_chunks::<2>().0,
        scale,
        soft: 0.01 * params.support_radius * params.support_radius,
        diffusion: params.density_diffusion * params.support_radius * params.sound_speed,
        hydrostatic: (hydrostatic * params.body_acceleration(state.time)).extend(0.0),
        rest_strain: if BODIES { rest_strain(params) } else { 0.0 },
        kernel: PhantomData,
    };
    let sorted =
        Sorted::new(params.support_radius, grid, cell_start, positions).with_images(Images::new(params));
    pairs::for_each(sorted, (densities, corrections.as_chunks_mut::<2>().0), &pass);
}

struct Continuity<'a, K, const BODIES: bool> {
    params: &'a Params,
    dt: f32,
    positions: &'a [Vec4],
    /// The density is the fourth component.
    velocities: &'a [Vec4],
    /// Contributions of bodies to M across their surfaces, and as the fourth component of the first vector the part of the
    /// kernel inside them.
    boundary: &'a [[Vec4; 2]],
    scale: f32,
    soft: f32,
    diffusion: f32,
    /// The hydrostatic gradient of the density in kg/m^4.
    hydrostatic: Vec4,
    /// Below this rate of strain the particles are not shifted.
    rest_strain: f32,
    kernel: PhantomData<K>,
}

/// The sums: -M (xx, yy, zz, xy, xz, yz), the velocity gradient (xx, yy, zz, and the sums of xy and yx, xz and zx, yz
/// and zy), and the diffusion.
impl<K: Kernel, const BODIES: bool> PairSum<8, 13> for Continuity<'_, K, BODIES> {
    type Output = (Vec2, [Vec4; 2]);

    #[inline(always)]
    fn load(&self, j: usize) -> [f32; 8] {
        let (p, v, scale) = (self.positions[j], self.velocities[j], self.scale);
        let weight = self.params.summed_mass * (scale * scale) * (scale * scale) * scale / v.w;
        [p.x, p.y, p.z, v.x, v.y, v.z, v.w, weight]
    }

    #[inline(always)]
    fn pair<V: Register>(&self, i: usize) -> impl Fn([V; 8]) -> [V; 13] {
        let (x, v) = (splat::<V>(self.positions[i]), splat::<V>(self.velocities[i]));
        let (rho, hydrostatic) = (V::splat(self.velocities[i].w), splat::<V>(self.hydrostatic));
        #[inline(always)]
        move |[x_j, y_j, z_j, u_j, v_j, w_j, rho_j, weight]| {
            let d = difference(x, [x_j, y_j, z_j]);
            let r2 = dot(d, d);
            let v = difference(v, [u_j, v_j, w_j]);
            let psi = rho_j - rho + dot(hydrostatic, d);
            let g = K::g(r2.sqrt() * self.scale) * weight;
            let [a, b, c] = scaled(g, d);
            [
                a * d[0],
                b * d[1],
                c * d[2],
                a * d[1],
                a * d[2],
                b * d[2],
                v[0] * a,
                v[1] * b,
                v[2] * c,
                v[0] * b + v[1] * a,
                v[0] * c + v[2] * a,
                v[1] * c + v[2] * b,
                g * psi * (r2 / (r2 + self.soft)),
            ]
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
    fn finish(&self, i: usize, sums: [f32; 13]) -> (Vec2, [Vec4; 2]) {
        let [xx, yy, zz, xy, xz, yz, uxx, uyy, uzz, uxy, uxz, uyz, diffusion] = sums;
        let fluid = Symmetric { diagonal: -Vec3::new(xx, yy, zz), others: -Vec3::new(xy, xz, yz) };
        let strain = Symmetric { diagonal: Vec3::new(uxx, uyy, uzz), others: 0.5 * Vec3::new(uxy, uxz, uyz) };
        let (mut whole, mut open, mut away) = (fluid, 1.0, 1.0);
        let mut divergence = None;
        if BODIES && self.boundary[i][0].w > 0.0 {
            // Across the surface of a body the solid is a part of the kernel. Along the surface the fluid alone determines
            // the derivatives, and the correction divides by what the body leaves open.
            let (across, fraction) = (Symmetric::from_vectors(self.boundary[i]), self.boundary[i][0].w);
            let without = fluid.plus(across);
            divergence = Some(correction(without).0.contract(strain));
            whole = without.plus(across.rest_of_unit().times(fraction));
            open = (1.0 - 20.0 * fraction).max(0.0);
            away = (1.0 - 100.0 * fraction).max(0.0);
        }
        let (b, determinant) = correction(whole);
        let divergence = divergence.unwrap_or(b.contract(strain));
        let rho = self.velocities[i].w;
        let rate = divergence + away * volume_recovery(self.params, whole, strain, determinant);
        let next = rho + self.dt * (rho * rate - self.diffusion * diffusion);
        let next = without_tension(self.params, next, determinant);
        let shifting = away * shifting(self.params, strain, self.rest_strain, determinant);
        let density = Vec2::new(next, self.params.pressure_at(next));
        let diagonal = open * b.diagonal + (1.0 - open) / self.params.lattice_moment;
        (density, [diagonal.extend(shifting), (open * b.others).extend(0.0)])
    }
}
