//! What is round a point, on the CPU; the twin of `surroundings.wgsl`.

use glam::{Vec3, Vec4, Vec4Swizzles};

use crate::cells::Grid;
use crate::kernel::{Kernel, WendlandC2};
use crate::state::Params;

/// The sorted fluid.
pub(super) struct Around<'a> {
    pub params: &'a Params,
    pub grid: &'a Grid,
    pub cell_start: &'a [u32],
    pub positions: &'a [Vec4],
    pub velocities: &'a [Vec4],
}

/// What is round a point.
pub(super) struct Surroundings {
    /// The fluid's velocity there in m/s.
    pub velocity: Vec3,
    /// The number of its neighbours as if no wall cut the support.
    pub neighbours: f32,
}

impl Around<'_> {
    pub fn at(&self, x: Vec3) -> Surroundings {
        let scale = 1.0 / self.params.support_radius;
        let reach = self.params.support_radius * self.params.support_radius;
        let (width, plane) = (self.grid.size_x as usize, (self.grid.size_x * self.grid.size_y) as usize);
        let cell = self.grid.cell_of(x) as usize;
        let (mut found, mut sum) = (0.0, Vec4::ZERO);
        for side in [cell - plane, cell, cell + plane] {
            for middle in [side - width, side, side + width] {
                let run = self.cell_start[middle - 1] as usize..self.cell_start[middle + 2] as usize;
                for (p, v) in self.positions[run.clone()].iter().zip(&self.velocities[run]) {
                    let r2 = (x - p.xyz()).length_squared();
                    if r2 < reach {
                        sum += WendlandC2::w(r2.sqrt() * scale) * v.xyz().extend(1.0);
                        found += 1.0;
                    }
                }
            }
        }
        let mut part = 1.0;
        for axis in 0..3 {
            let is_closed = |side: usize| self.params.closed >> (2 * axis + side) & 1 == 1;
            if is_closed(0) {
                part *= part_inside((x[axis] - self.params.domain_min[axis]) * scale);
            }
            if is_closed(1) {
                part *= part_inside((self.params.domain_max[axis] - x[axis]) * scale);
            }
        }
        Surroundings { velocity: sum.xyz() / sum.w.max(1e-20), neighbours: found / part }
    }
}

/// The part of a ball's volume on this side of a plane at `distance` from its centre, in radii.
fn part_inside(distance: f32) -> f32 {
    let t = distance.clamp(0.0, 1.0);
    0.5 + t * (0.75 - 0.25 * t * t)
}
