use std::marker::PhantomData;

use glam::{Vec2, Vec3, Vec4, Vec4Swizzles};
use splashdown_gpu::{CpuWork, Slot};

use crate::boundary::WallKernel;
use crate::cells::Grid;
use crate::kernel::Kernel;
use crate::passes::rows::{self, Window};
use crate::passes::simd::{Leaf, vectorised};
use crate::passes::{Params, StepState};

const LANES: usize = 16;

pub(super) fn continuity<K: Kernel + WallKernel>(_: CpuWork, slots: &mut [Slot<'_>]) {
    let [params, grid, state, cell_start, positions, velocities, wall_table, densities] = slots else {
        unreachable!()
    };
    let (params, grid, state) = (&params.get::<Params>(), &grid.get::<Grid>(), state.get::<StepState>());
    let cell_start = cell_start.read::<u32>();
    let (positions, velocities) = (positions.read::<Vec4>(), velocities.read::<Vec4>());
    let (walls, wall_table) = (params.walls(K::WALLS), wall_table.read::<Vec4>());
    let body = params.body_acceleration(state.time);
    let scale = 1.0 / params.support_radius;
    rows::for_each(grid, cell_start, densities.write::<Vec2>(), |window, row, places, out| {
        let kernel = PhantomData;
        vectorised(Row::<K> {
            params,
            grid,
            body,
            cell_start,
            positions,
            velocities,
            row,
            window,
            out,
            kernel,
        });
        for (i, out) in places.zip(out) {
            let (x, v) = (positions[i].xyz(), velocities[i]);
            let mut rate = out.x;
            if walls.near(x) {
                let terms = walls.terms(wall_table, x);
                rate -= 2.0 * v.w * scale * (terms.slope * terms.normal).dot(v.xyz());
            }
            let next = v.w + state.dt * rate;
            *out = Vec2::new(next, params.pressure_at(next));
        }
    });
}

/// The rates of density, without the walls, of the particles in one row of cells.
struct Row<'a, K> {
    params: &'a Params,
    grid: &'a Grid,
    body: Vec3,
    cell_start: &'a [u32],
    positions: &'a [Vec4],
    velocities: &'a [Vec4],
    row: usize,
    window: &'a mut Window<8>,
    out: &'a mut [Vec2],
    kernel: PhantomData<K>,
}

impl<K: Kernel> Leaf for Row<'_, K> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let (params, row, positions, velocities) = (self.params, self.row, self.positions, self.velocities);
        let support = params.support_radius;
        let scale = 1.0 / support;
        let factor = params.particle_mass * (scale * scale) * (scale * scale) * scale;
        // The padding has specific mass zero, so it adds nothing.
        self.window.gather(self.grid, self.cell_start, row, |j| {
            let (p, v) = (positions[j], velocities[j]);
            [p.x, p.y, p.z, v.x, v.y, v.z, v.w, factor / v.w]
        });
        let soft = 0.01 * support * support;
        let diffusion = params.density_diffusion * support * params.sound_speed;
        let hydrostatic = params.rest_density / (params.sound_speed * params.sound_speed) * self.body;
        let first = self.cell_start[row] as usize;
        for (x, places) in rows::occupied(self.grid, self.cell_start, row) {
            let c = self.window.candidates::<LANES>(x);
            for i in places {
                let (p, v) = (positions[i], velocities[i]);
                let mut sum = [0.0; LANES];
                #[expect(
                    clippy::needless_range_loop,
                    reason = "all columns are read at k; zips do not vectorise"
                )]
                for k in 0..c[0].len() {
                    let (xs, ys, zs, us) = (&c[0][k], &c[1][k], &c[2][k], &c[3][k]);
                    let (vs, ws, rhos, weights) = (&c[4][k], &c[5][k], &c[6][k], &c[7][k]);
                    for l in 0..LANES {
                        let (dx, dy, dz) = (p.x - xs[l], p.y - ys[l], p.z - zs[l]);
                        let r2 = dx * dx + dy * dy + dz * dz;
                        let vx = (v.x - us[l]) * dx + (v.y - vs[l]) * dy + (v.z - ws[l]) * dz;
                        let psi =
                            rhos[l] - v.w + (hydrostatic.x * dx + hydrostatic.y * dy + hydrostatic.z * dz);
                        let flow = v.w * vx - diffusion * psi * (r2 / (r2 + soft));
                        sum[l] += K::g(r2.sqrt() * scale) * weights[l] * flow;
                    }
                }
                self.out[i - first].x = rows::sum(sum);
            }
        }
    }
}
