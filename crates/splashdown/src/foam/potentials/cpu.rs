use glam::{Vec4, Vec4Swizzles};
use splashdown_gpu::{CpuWork, Slot};

use crate::cells::Grid;
use crate::foam::{FoamParams, FoamState};
use crate::kernel::{self, Kernel, WendlandC2};
use crate::passes::Params;
use crate::passes::rows::{self, Window};
use crate::passes::simd::{Leaf, vectorised};

const LANES: usize = 8;
const FORWARDS: f32 = 0.6;

pub(super) fn potentials(_: CpuWork, slots: &mut [Slot<'_>]) {
    let [params, grid, foam, foam_state, cell_start, positions, velocities, normals, potentials] = slots
    else {
        unreachable!()
    };
    if foam_state.get::<FoamState>().is_due == 0 {
        return;
    }
    let (params, grid) = (&params.get::<Params>(), &grid.get::<Grid>());
    let (cell_start, positions) = (cell_start.read::<u32>(), positions.read::<Vec4>());
    let (velocities, normals) = (velocities.read::<Vec4>(), normals.read::<Vec4>());
    let least = foam.get::<FoamParams>().energy_least;
    rows::for_each(grid, cell_start, potentials.write::<Vec4>(), |window, row, places, out| {
        let energy = |i: usize| 0.5 * velocities[i].xyz().length_squared();
        for (i, potentials) in places.clone().zip(out.iter_mut()) {
            *potentials = Vec4::new(0.0, 0.0, energy(i), 0.0);
        }
        if out.iter().any(|potentials| potentials.z > least) {
            vectorised(Row {
                params,
                grid,
                cell_start,
                positions,
                velocities,
                normals,
                least,
                row,
                window,
                out,
            });
        }
    });
}

struct Row<'a> {
    params: &'a Params,
    grid: &'a Grid,
    cell_start: &'a [u32],
    positions: &'a [Vec4],
    velocities: &'a [Vec4],
    normals: &'a [Vec4],
    least: f32,
    row: usize,
    window: &'a mut Window<10>,
    out: &'a mut [Vec4],
}

impl Leaf for Row<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let scale = 1.0 / self.params.support_radius;
        let share = self.params.particle_spacing * scale;
        let volume = share * share * share;
        let (row, positions, velocities, normals) = (self.row, self.positions, self.velocities, self.normals);
        self.window.gather(self.grid, self.cell_start, row, |j| {
            let (p, v, n) = (positions[j], velocities[j], normals[j]);
            [p.x, p.y, p.z, v.x, v.y, v.z, n.x, n.y, n.z, n.w]
        });
        let first = self.cell_start[row] as usize;
        for (x, places) in rows::occupied(self.grid, self.cell_start, row) {
            let columns = self.window.candidates::<LANES>(x);
            for i in places {
                if self.out[i - first].z <= self.least {
                    continue;
                }
                let (p, v, n) = (positions[i], velocities[i].xyz(), normals[i]);
                let (mut trapped, mut curvature) = ([0.0; LANES], [0.0; LANES]);
                for k in 0..columns[0].len() {
                    let [xs, ys, zs, us, vs, ws, ns, os, ps, on_surface] = columns.map(|column| &column[k]);
                    for l in 0..LANES {
                        let (dx, dy, dz) = (p.x - xs[l], p.y - ys[l], p.z - zs[l]);
                        let (du, dv, dw) = (v.x - us[l], v.y - vs[l], v.z - ws[l]);
                        let r2 = dx * dx + dy * dy + dz * dz;
                        let w = WendlandC2::w(r2.sqrt() * scale);
                        let speed = (du * du + dv * dv + dw * dw).sqrt();
                        let parting = (du * dx + dv * dy + dw * dz) / kernel::max(r2, 1e-20).sqrt();
                        trapped[l] += w * (speed - parting);
                        let is_behind = dx * n.x + dy * n.y + dz * n.z > 0.0;
                        let bend = 1.0 - (ns[l] * n.x + os[l] * n.y + ps[l] * n.z);
                        curvature[l] += if is_behind { w * on_surface[l] * bend } else { 0.0 };
                    }
                }
                let is_crest = v.dot(n.xyz()) >= FORWARDS * v.length() && n.w > 0.0;
                let potentials = &mut self.out[i - first];
                potentials.x = volume * rows::sum(trapped);
                potentials.y = if is_crest { volume * rows::sum(curvature) } else { 0.0 };
            }
        }
    }
}
