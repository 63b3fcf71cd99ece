use glam::{Vec3, Vec4, Vec4Swizzles};

use super::NormalsBindings;
use crate::kernel::{Kernel, WendlandC2};
use crate::pairs::{self, PairSum, Sorted, difference, dot, scaled, splat};
use crate::simd::Register;
use crate::state::Params;

const LEAST_NORMAL: f32 = 0.5;

pub(super) fn normals(buffers: NormalsBindings<'_>) {
    let NormalsBindings {
        params,
        grid,
        foam_state,
        cell_start,
        sorted_positions: positions,
        foam_normals: normals,
    } = buffers;
    if foam_state.is_due == 0 {
        return;
    }
    let scale = 1.0 / params.support_radius;
    let share = params.particle_spacing * scale;
    let pass = Normals { params, positions, scale, factor: -share * share * share * scale };
    pairs::for_each(Sorted::new(params.support_radius, grid, cell_start, positions), normals, &pass);
}

struct Normals<'a> {
    params: &'a Params,
    positions: &'a [Vec4],
    scale: f32,
    factor: f32,
}

impl PairSum<3, 3> for Normals<'_> {
    type Output = Vec4;

    #[inline(always)]
    fn load(&self, j: usize) -> [f32; 3] {
        self.positions[j].xyz().to_array()
    }

    #[inline(always)]
    fn pair<V: Register>(&self, i: usize) -> impl Fn([V; 3]) -> [V; 3] {
        let x = splat::<V>(self.positions[i]);
        #[inline(always)]
        move |other| {
            let d = difference(x, other);
            scaled(WendlandC2::g(dot(d, d).sqrt() * self.scale), d)
        }
    }

    #[inline(always)]
    fn finish(&self, i: usize, sums: [f32; 3]) -> Vec4 {
        on_surface(self.params, self.positions[i].xyz(), self.factor * Vec3::from(sums))
    }
}

#[inline(always)]
fn on_surface(params: &Params, x: Vec3, mut n: Vec3) -> Vec4 {
    for axis in 0..3 {
        let is_closed = |side: usize| params.closed >> (2 * axis + side) & 1 == 1;
        let low = is_closed(0) && x[axis] - params.domain_min[axis] < params.support_radius;
        let high = is_closed(1) && params.domain_max[axis] - x[axis] < params.support_radius;
        if (low && n[axis] < 0.0) || (high && n[axis] > 0.0) {
            n[axis] = 0.0;
        }
    }
    let size = n.length();
    if size >= LEAST_NORMAL { (n / size).extend(1.0) } else { Vec4::ZERO }
}
