use std::f32::consts::PI;
use std::marker::PhantomData;

use glam::{Vec2, Vec3, Vec4, Vec4Swizzles};
use splashdown_gpu::{CpuWork, Slot};

use crate::boundary::{WallKernel, Walls};
use crate::cells::Grid;
use crate::kernel::{Kernel, SMALLEST_Q, max};
use crate::passes::rows::{self, Window};
use crate::passes::simd::{Leaf, vectorised};
use crate::passes::{Params, StepState};

const LANES: usize = 8;

pub(super) fn momentum<K: Kernel + WallKernel>(_: CpuWork, slots: &mut [Slot<'_>]) {
    let [
        params,
        grid,
        state,
        cell_start,
        positions,
        velocities,
        densities,
        normals,
        wall_table,
        accelerations,
    ] = slots
    else {
        unreachable!()
    };
    let params = params.get::<Params>();
    let input = Input {
        params: &params,
        grid: &grid.get(),
        state: &state.get(),
        cell_start: cell_start.read(),
        positions: positions.read(),
        velocities: velocities.read(),
        densities: densities.read(),
        normals: normals.read(),
        wall_table: wall_table.read(),
        walls: params.walls(K::WALLS),
    };
    let out = accelerations.write::<Vec4>();
    // Columns and arithmetic that a scene does not ask for cost nothing: each combination is compiled by itself.
    if params.surface_tension > 0.0 {
        input.run::<K, 11, true>(out);
    } else {
        input.run::<K, 7, false>(out);
    }
}

struct Input<'a> {
    params: &'a Params,
    grid: &'a Grid,
    state: &'a StepState,
    cell_start: &'a [u32],
    positions: &'a [Vec4],
    velocities: &'a [Vec4],
    densities: &'a [Vec2],
    normals: &'a [Vec4],
    wall_table: &'a [Vec4],
    walls: Walls,
}

impl Input<'_> {
    fn run<K: Kernel, const F: usize, const TENSION: bool>(&self, out: &mut [Vec4]) {
        let body = self.params.body_acceleration(self.state.time);
        rows::for_each(self.grid, self.cell_start, out, |window, row, places, out| {
            let kernel = PhantomData;
            vectorised(Row::<K, F, TENSION> { input: self, row, window, out, kernel });
            for (i, a) in places.zip(out) {
                if self.walls.near(self.positions[i].xyz()) {
                    self.add_walls(i, body, a);
                }
                *a += body.extend(0.0);
            }
        });
    }

    /// Turns what the neighbours do into what neighbours and walls do.
    fn add_walls(&self, i: usize, body: Vec3, a: &mut Vec4) {
        let params = self.params;
        let terms = self.walls.terms(self.wall_table, self.positions[i].xyz());
        let [rho, pressure] = self.densities[i].to_array();
        let push = params.rest_density * pressure / (rho * rho) + pressure / params.rest_density;
        let v = self.velocities[i].xyz();
        *a = terms.acceleration(params, v, body, a.xyz(), push, self.state.dt).extend(0.0);
    }
}

/// Akinci's cohesion kernel times H^3 for q in [0, 1]; both branches meet at q = 1/2.
#[inline(always)]
fn cohesion(q: f32) -> f32 {
    let t = max(1.0 - q, 0.0) * q;
    let t3 = t * t * t;
    32.0 / PI * if q <= 0.5 { 2.0 * t3 - 1.0 / 64.0 } else { t3 }
}

/// The sums over the neighbours of the particles in one row of cells.
struct Row<'a, 'b, K, const F: usize, const TENSION: bool> {
    input: &'a Input<'b>,
    row: usize,
    window: &'a mut Window<F>,
    out: &'a mut [Vec4],
    kernel: PhantomData<K>,
}

impl<K: Kernel, const F: usize, const TENSION: bool> Leaf for Row<'_, '_, K, F, TENSION> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Input { params, grid, cell_start, positions, velocities, densities, normals, .. } = *self.input;
        self.window.gather(grid, cell_start, self.row, |j| {
            let (p, v, [rho, pressure]) = (positions[j], velocities[j], densities[j].to_array());
            let mut values = [0.0; F];
            values[..7].copy_from_slice(&[p.x, p.y, p.z, v.x, v.y, v.z, pressure / (rho * rho)]);
            if TENSION {
                values[7] = rho;
                values[8..].copy_from_slice(&normals[j].to_array()[..3]);
            }
            values
        });

        let support = params.support_radius;
        let scale = 1.0 / support;
        let scale2 = scale * scale;
        let scale5 = scale2 * scale2 * scale;
        let soft = 0.01 * support * support;
        let mass = params.particle_mass;
        let volume = mass / params.rest_density;
        let laminar = 10.0 * params.viscosity * volume;
        let artificial = params.artificial_viscosity * params.sound_speed * 0.5 * support * volume;
        let tension = -2.0 * params.surface_tension * params.rest_density;

        let first = cell_start[self.row] as usize;
        for (x, places) in rows::occupied(grid, cell_start, self.row) {
            let c = self.window.candidates::<LANES>(x);
            for i in places {
                let (p, v, [rho, pressure]) = (positions[i], velocities[i], densities[i].to_array());
                let specific = pressure / (rho * rho);
                let n = if TENSION { normals[i].xyz() } else { Vec3::ZERO };
                let mut sums = [[0.0; LANES]; 3];
                #[expect(
                    clippy::needless_range_loop,
                    reason = "all columns are read at k; zips do not vectorise"
                )]
                for k in 0..c[0].len() {
                    let (xs, ys, zs, us, vs, ws, ps) =
                        (&c[0][k], &c[1][k], &c[2][k], &c[3][k], &c[4][k], &c[5][k], &c[6][k]);
                    for l in 0..LANES {
                        let (dx, dy, dz) = (p.x - xs[l], p.y - ys[l], p.z - zs[l]);
                        let r2 = dx * dx + dy * dy + dz * dz;
                        let q = r2.sqrt() * scale;
                        let g = K::g(q) * scale5;
                        let vx = (v.x - us[l]) * dx + (v.y - vs[l]) * dy + (v.z - ws[l]) * dz;
                        let soft_r2 = r2 + soft;
                        let rub = vx / soft_r2 * (laminar + if vx < 0.0 { artificial } else { 0.0 });
                        let along = g * (rub - mass * (specific + ps[l]));
                        sums[0][l] += along * dx;
                        sums[1][l] += along * dy;
                        sums[2][l] += along * dz;
                    }
                    if TENSION {
                        // A loop of its own: in one with the rest the compiler gives up vectorising.
                        let (rhos, nx, ny, nz) = (&c[7][k], &c[8][k], &c[9][k], &c[10][k]);
                        for l in 0..LANES {
                            let (dx, dy, dz) = (p.x - xs[l], p.y - ys[l], p.z - zs[l]);
                            let q = (dx * dx + dy * dy + dz * dz).sqrt() * scale;
                            let inside = if q < 1.0 { tension } else { 0.0 };
                            let factor = inside / (rho + rhos[l]);
                            let pull = mass * scale2 * scale2 * cohesion(q) / max(q, SMALLEST_Q);
                            sums[0][l] += factor * (pull * dx + n.x - nx[l]);
                            sums[1][l] += factor * (pull * dy + n.y - ny[l]);
                            sums[2][l] += factor * (pull * dz + n.z - nz[l]);
                        }
                    }
                }
                let [ax, ay, az] = sums.map(rows::sum);
                self.out[i - first] = Vec4::new(ax, ay, az, 0.0);
            }
        }
    }
}
