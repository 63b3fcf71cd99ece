use glam::{Vec2, Vec4, Vec4Swizzles};
use splashdown_gpu::{CpuWork, Slot};

use crate::boundary::WallKernel;
use crate::cells::Grid;
use crate::kernel::Kernel;
use crate::passes::Params;
use crate::passes::rows::{self, Window};
use crate::passes::simd::{Leaf, vectorised};

const LANES: usize = 16;

pub(super) fn density<K: Kernel + WallKernel>(_: CpuWork, slots: &mut [Slot<'_>]) {
    let [params, grid, cell_start, positions, wall_table, densities] = slots else { unreachable!() };
    let (params, grid) = (&params.get::<Params>(), &grid.get::<Grid>());
    let (cell_start, positions) = (cell_start.read::<u32>(), positions.read::<Vec4>());
    let (walls, wall_table) = (params.walls(K::WALLS), wall_table.read::<Vec4>());
    rows::for_each(grid, cell_start, densities.write::<Vec2>(), |window, row, places, out| {
        vectorised(Row::<K> {
            params,
            grid,
            cell_start,
            positions,
            row,
            window,
            out,
            kernel: std::marker::PhantomData,
        });
        for (x, out) in positions[places].iter().zip(out) {
            if walls.near(x.xyz()) {
                out.x += params.rest_density * walls.terms(wall_table, x.xyz()).density;
            }
            out.y = params.pressure_at(out.x);
        }
    });
}

/// The sums over the neighbours of the particles in one row of cells.
struct Row<'a, K> {
    params: &'a Params,
    grid: &'a Grid,
    cell_start: &'a [u32],
    positions: &'a [Vec4],
    row: usize,
    window: &'a mut Window<3>,
    out: &'a mut [Vec2],
    kernel: std::marker::PhantomData<K>,
}

impl<K: Kernel> Leaf for Row<'_, K> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let scale = 1.0 / self.params.support_radius;
        let factor = self.params.particle_mass * scale * scale * scale;
        let (row, positions) = (self.row, self.positions);
        self.window.gather(self.grid, self.cell_start, row, |j| {
            let p = positions[j];
            [p.x, p.y, p.z]
        });
        let first = self.cell_start[row] as usize;
        for (x, places) in rows::occupied(self.grid, self.cell_start, row) {
            let [xs, ys, zs] = self.window.candidates::<LANES>(x);
            for i in places {
                let p = positions[i];
                let mut lanes = [0.0; LANES];
                for ((xs, ys), zs) in xs.iter().zip(ys).zip(zs) {
                    for l in 0..LANES {
                        let (dx, dy, dz) = (p.x - xs[l], p.y - ys[l], p.z - zs[l]);
                        let q = (dx * dx + dy * dy + dz * dz).sqrt() * scale;
                        lanes[l] += K::w(q);
                    }
                }
                self.out[i - first].x = factor * rows::sum(lanes);
            }
        }
    }
}
