use glam::{Vec4, Vec4Swizzles};

use super::PotentialsBindings;
use crate::kernel::{Kernel, WendlandC2};
use crate::pairs::{self, PairSum, Sorted, difference, dot, splat};
use crate::simd::Register;

/// Cosine of the largest angle between the velocity and the normal of a wave crest.
const FORWARDS: f32 = 0.6;

pub(super) fn potentials(buffers: PotentialsBindings<'_>) {
    let PotentialsBindings {
        params,
        grid,
        foam,
        foam_state,
        cell_start,
        sorted_positions: positions,
        sorted_velocities: velocities,
        foam_normals: normals,
        foam_potentials: potentials,
    } = buffers;
    if foam_state.is_due == 0 {
        return;
    }
    let scale = 1.0 / params.support_radius;
    let share = params.particle_spacing * scale;
    let pass = Potentials {
        positions,
        velocities,
        normals,
        least: foam.energy_least,
        scale,
        volume: share * share * share,
    };
    pairs::for_each(Sorted::new(params.support_radius, grid, cell_start, positions), potentials, &pass);
}

struct Potentials<'a> {
    positions: &'a [Vec4],
    velocities: &'a [Vec4],
    /// Normals of surface particles, with a fourth component of 1; zero for other particles.
    normals: &'a [Vec4],
    least: f32,
    scale: f32,
    volume: f32,
}

impl Potentials<'_> {
    #[inline(always)]
    fn energy(&self, i: usize) -> f32 {
        0.5 * self.velocities[i].xyz().length_squared()
    }
}

impl PairSum<10, 2> for Potentials<'_> {
    type Output = Vec4;

    #[inline(always)]
    fn load(&self, j: usize) -> [f32; 10] {
        let (p, v, n) = (self.positions[j], self.velocities[j], self.normals[j]);
        [p.x, p.y, p.z, v.x, v.y, v.z, n.x, n.y, n.z, n.w]
    }

    /// Trapped air and curvature.
    #[inline(always)]
    fn pair<V: Register>(&self, i: usize) -> impl Fn([V; 10]) -> [V; 2] {
        let (x, v, n) =
            (splat::<V>(self.positions[i]), splat::<V>(self.velocities[i]), splat::<V>(self.normals[i]));
        let (zero, one, smallest) = (V::splat(0.0), V::splat(1.0), V::splat(1e-20));
        #[inline(always)]
        move |[x_j, y_j, z_j, u_j, v_j, w_j, n_x, n_y, n_z, on_surface]| {
            let d = difference(x, [x_j, y_j, z_j]);
            let dv = difference(v, [u_j, v_j, w_j]);
            let r2 = dot(d, d);
            let w = WendlandC2::w(r2.sqrt() * self.scale);
            let separation_speed = dot(dv, d) / r2.max(smallest).sqrt();
            let bend = one - dot([n_x, n_y, n_z], n);
            // Only neighbours behind the surface contribute to the curvature.
            let curvature = zero.if_less(dot(d, n), w * on_surface * bend, zero);
            [w * (dot(dv, dv).sqrt() - separation_speed), curvature]
        }
    }

    #[inline(always)]
    fn finish(&self, i: usize, [trapped, curvature]: [f32; 2]) -> Vec4 {
        let (v, n) = (self.velocities[i].xyz(), self.normals[i]);
        let is_crest = v.dot(n.xyz()) >= FORWARDS * v.length() && n.w > 0.0;
        let curvature = if is_crest { self.volume * curvature } else { 0.0 };
        Vec4::new(self.volume * trapped, curvature, self.energy(i), 0.0)
    }

    /// Particles that are too slow to generate foam are skipped.
    #[inline(always)]
    fn wants(&self, i: usize) -> bool {
        self.energy(i) > self.least
    }
}
