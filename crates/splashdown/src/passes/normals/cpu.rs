use std::marker::PhantomData;

use glam::{Vec2, Vec4};
use splashdown_gpu::{CpuWork, Slot};

use crate::cells::Grid;
use crate::kernel::Kernel;
use crate::passes::Params;
use crate::passes::rows::{self, Window};
use crate::passes::simd::{Leaf, vectorised};

const LANES: usize = 16;

pub(super) fn normals<K: Kernel>(_: CpuWork, slots: &mut [Slot<'_>]) {
    let [params, grid, cell_start, positions, densities, normals] = slots else { unreachable!() };
    let (params, grid) = (&params.get::<Params>(), &grid.get::<Grid>());
    let (cell_start, positions) = (cell_start.read::<u32>(), positions.read::<Vec4>());
    let densities = densities.read::<Vec2>();
    rows::for_each(grid, cell_start, normals.write::<Vec4>(), |window, row, _, out| {
        let kernel = PhantomData;
        vectorised(Row::<K> { params, grid, cell_start, positions, densities, row, window, out, kernel });
    });
}

struct Row<'a, K> {
    params: &'a Params,
    grid: &'a Grid,
    cell_start: &'a [u32],
    positions: &'a [Vec4],
    densities: &'a [Vec2],
    row: usize,
    window: &'a mut Window<4>,
    out: &'a mut [Vec4],
    kernel: PhantomData<K>,
}

impl<K: Kernel> Leaf for Row<'_, K> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let scale = 1.0 / self.params.support_radius;
        let factor = self.params.particle_mass * (scale * scale) * (scale * scale);
        let (row, positions, densities) = (self.row, self.positions, self.densities);
        self.window.gather(self.grid, self.cell_start, row, |j| {
            let p = positions[j];
            [p.x, p.y, p.z, 1.0 / densities[j].x]
        });
        let first = self.cell_start[row] as usize;
        for (x, places) in rows::occupied(self.grid, self.cell_start, row) {
            let [xs, ys, zs, specific] = self.window.candidates::<LANES>(x);
            for i in places {
                let p = positions[i];
                let mut sums = [[0.0; LANES]; 3];
                for (((xs, ys), zs), specific) in xs.iter().zip(ys).zip(zs).zip(specific) {
                    for l in 0..LANES {
                        let (dx, dy, dz) = (p.x - xs[l], p.y - ys[l], p.z - zs[l]);
                        let q = (dx * dx + dy * dy + dz * dz).sqrt() * scale;
                        let c = K::g(q) * specific[l];
                        sums[0][l] += c * dx;
                        sums[1][l] += c * dy;
                        sums[2][l] += c * dz;
                    }
                }
                let [nx, ny, nz] = sums.map(rows::sum);
                self.out[i - first] = factor * Vec4::new(nx, ny, nz, 0.0);
            }
        }
    }
}
