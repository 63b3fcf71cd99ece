use glam::{Vec2, Vec3, Vec4, Vec4Swizzles};
use splashdown_gpu::{CpuWork, Slot};

use crate::boundary::KernelPair;
use crate::cells::Grid;
use crate::kernel::{Kernel, Poly6, Spiky, viscosity_laplacian};
use crate::passes::rows::{self, Window};
use crate::passes::simd::{Leaf, vectorised};
use crate::passes::{Params, StepState};

const LANES: usize = 16;

pub(super) fn mueller(_: CpuWork, slots: &mut [Slot<'_>]) {
    let [params, grid, state, cell_start, positions, velocities, densities, wall_table, accelerations] =
        slots
    else {
        unreachable!()
    };
    let (params, grid, state) = (&params.get::<Params>(), &grid.get::<Grid>(), &state.get::<StepState>());
    let cell_start = cell_start.read::<u32>();
    let (positions, velocities) = (positions.read::<Vec4>(), velocities.read::<Vec4>());
    let (densities, wall_table) = (densities.read::<Vec2>(), wall_table.read::<Vec4>());
    let walls = params.walls(KernelPair::Mueller);
    let body = params.body_acceleration(state.time);
    rows::for_each(grid, cell_start, accelerations.write::<Vec4>(), |window, row, places, out| {
        vectorised(Row { params, grid, cell_start, positions, velocities, densities, row, window, out });
        for (i, a) in places.zip(out) {
            if walls.near(positions[i].xyz()) {
                let terms = walls.terms(wall_table, positions[i].xyz());
                let [rho, pressure] = densities[i].to_array();
                let v = velocities[i].xyz();
                *a = terms.acceleration(params, v, body, a.xyz(), pressure / rho, state.dt).extend(0.0);
            }
            *a += body.extend(0.0);
        }
    });
}

/// The sums over the neighbours of the particles in one row of cells.
struct Row<'a> {
    params: &'a Params,
    grid: &'a Grid,
    cell_start: &'a [u32],
    positions: &'a [Vec4],
    velocities: &'a [Vec4],
    densities: &'a [Vec2],
    row: usize,
    window: &'a mut Window<8>,
    out: &'a mut [Vec4],
}

impl Leaf for Row<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { params, grid, cell_start, positions, velocities, densities, row, window, out } = self;
        let mass = params.particle_mass;
        window.gather(grid, cell_start, row, |j| {
            let (p, v, [rho, pressure]) = (positions[j], velocities[j], densities[j].to_array());
            [p.x, p.y, p.z, v.x, v.y, v.z, pressure, mass / rho]
        });
        let scale = 1.0 / params.support_radius;
        let scale5 = (scale * scale) * (scale * scale) * scale;
        let friction = params.viscosity * params.rest_density;
        let first = cell_start[row] as usize;
        for (x, places) in rows::occupied(grid, cell_start, row) {
            let c = window.candidates::<LANES>(x);
            for i in places {
                let (p, v, [rho, pressure]) = (positions[i], velocities[i], densities[i].to_array());
                let mut sums = [[0.0; LANES]; 7];
                #[expect(
                    clippy::needless_range_loop,
                    reason = "all columns are read at k; zips do not vectorise"
                )]
                for k in 0..c[0].len() {
                    // One simple loop per quantity: the compiler vectorises each, and gives up on all of them in one.
                    let (xs, ys, zs, us) = (&c[0][k], &c[1][k], &c[2][k], &c[3][k]);
                    let (vs, ws, ps, volumes) = (&c[4][k], &c[5][k], &c[6][k], &c[7][k]);
                    let mut d = [[0.0; LANES]; 3];
                    let mut q = [0.0; LANES];
                    for l in 0..LANES {
                        d[0][l] = p.x - xs[l];
                        d[1][l] = p.y - ys[l];
                        d[2][l] = p.z - zs[l];
                        q[l] = (d[0][l] * d[0][l] + d[1][l] * d[1][l] + d[2][l] * d[2][l]).sqrt() * scale;
                    }
                    let mut push = [0.0; LANES];
                    let mut rub = [0.0; LANES];
                    let mut slope = [0.0; LANES];
                    for l in 0..LANES {
                        push[l] = -volumes[l] * 0.5 * (pressure + ps[l]) * Spiky::g(q[l]);
                    }
                    for l in 0..LANES {
                        rub[l] = friction * volumes[l] * viscosity_laplacian(q[l]);
                    }
                    for l in 0..LANES {
                        slope[l] = volumes[l] * Poly6::g(q[l]);
                        sums[6][l] += volumes[l] * Poly6::laplacian(q[l]);
                    }
                    for l in 0..LANES {
                        sums[0][l] += push[l] * d[0][l] + rub[l] * (us[l] - v.x);
                        sums[1][l] += push[l] * d[1][l] + rub[l] * (vs[l] - v.y);
                        sums[2][l] += push[l] * d[2][l] + rub[l] * (ws[l] - v.z);
                    }
                    for axis in 0..3 {
                        for l in 0..LANES {
                            sums[3 + axis][l] += slope[l] * d[axis][l];
                        }
                    }
                }
                let [fx, fy, fz, nx, ny, nz, laplacian] = sums.map(|lanes| scale5 * rows::sum(lanes));
                let (mut force, normal) = (Vec3::new(fx, fy, fz), Vec3::new(nx, ny, nz));
                let steepness = normal.length();
                if steepness > 0.5 * scale {
                    force -= params.surface_tension * laplacian / steepness * normal;
                }
                out[i - first] = (force / rho).extend(0.0);
            }
        }
    }
}
