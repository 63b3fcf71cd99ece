use glam::{Vec3, Vec4, Vec4Swizzles};
use splashdown_gpu::{CpuWork, Slot};

use crate::cells::Grid;
use crate::foam::FoamState;
use crate::kernel::{Kernel, WendlandC2};
use crate::passes::Params;
use crate::passes::rows::{self, Window};
use crate::passes::simd::{Leaf, vectorised};

const LANES: usize = 16;
const LEAST_NORMAL: f32 = 0.5;

pub(super) fn normals(_: CpuWork, slots: &mut [Slot<'_>]) {
    let [params, grid, foam_state, cell_start, positions, normals] = slots else { unreachable!() };
    if foam_state.get::<FoamState>().is_due == 0 {
        return;
    }
    let (params, grid) = (&params.get::<Params>(), &grid.get::<Grid>());
    let (cell_start, positions) = (cell_start.read::<u32>(), positions.read::<Vec4>());
    rows::for_each(grid, cell_start, normals.write::<Vec4>(), |window, row, _, out| {
        vectorised(Row { params, grid, cell_start, positions, row, window, out });
    });
}

struct Row<'a> {
    params: &'a Params,
    grid: &'a Grid,
    cell_start: &'a [u32],
    positions: &'a [Vec4],
    row: usize,
    window: &'a mut Window<3>,
    out: &'a mut [Vec4],
}

impl Leaf for Row<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let scale = 1.0 / self.params.support_radius;
        let share = self.params.particle_spacing * scale;
        let factor = share * share * share * scale;
        let (row, positions) = (self.row, self.positions);
        self.window.gather(self.grid, self.cell_start, row, |j| positions[j].xyz().to_array());
        let first = self.cell_start[row] as usize;
        for (x, places) in rows::occupied(self.grid, self.cell_start, row) {
            let [xs, ys, zs] = self.window.candidates::<LANES>(x);
            for i in places {
                let p = positions[i];
                let mut sums = [[0.0; LANES]; 3];
                for ((xs, ys), zs) in xs.iter().zip(ys).zip(zs) {
                    for l in 0..LANES {
                        let (dx, dy, dz) = (p.x - xs[l], p.y - ys[l], p.z - zs[l]);
                        let q = (dx * dx + dy * dy + dz * dz).sqrt() * scale;
                        let g = WendlandC2::g(q);
                        sums[0][l] -= g * dx;
                        sums[1][l] -= g * dy;
                        sums[2][l] -= g * dz;
                    }
                }
                let n = factor * Vec3::from(sums.map(rows::sum));
                self.out[i - first] = on_surface(self.params, p.xyz(), n);
            }
        }
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
