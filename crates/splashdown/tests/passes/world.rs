//! Random clouds of particles in a box, sorted on the host, with all inputs of the passes.

use glam::{Vec2, Vec3, Vec4, Vec4Swizzles};
use splashdown::cells::Grid;
use splashdown::state::{DEAD_ESCAPED, DEAD_NON_FINITE, Params, StepState};
use splashdown_gpu::{bytemuck, testing};

pub const SPACING: f32 = 0.05;

/// A cloud with constants. The arrays are ordered as after a sort: by cell, then by id, dead particles last.
#[derive(Clone)]
pub struct World {
    pub params: Params,
    pub grid: Grid,
    pub state: StepState,
    pub cell_start: Vec<u32>,
    pub positions: Vec<Vec4>,
    /// The fourth component is a density.
    pub velocities: Vec<Vec4>,
    pub ids: Vec<u32>,
    /// Density and pressure.
    pub densities: Vec<Vec2>,
    pub normals: Vec<Vec4>,
}

fn unit(i: usize) -> f32 {
    testing::noise(i as u32) as f32 / u32::MAX as f32
}

pub fn params(support_ratio: f32) -> Params {
    Params {
        gravity: Vec3::new(0.5, -9.81, 0.25),
        support_radius: support_ratio * SPACING,
        domain_min: Vec3::new(-0.3, 0.0, 0.1),
        particle_spacing: SPACING,
        domain_max: Vec3::new(0.3, 0.5, 0.7),
        particle_mass: 1000.0 * SPACING.powi(3),
        summed_mass: 1000.0 * SPACING.powi(3),
        oscillation: Vec3::new(1.5, 0.0, -0.5),
        oscillation_rate: 3.0,
        rest_density: 1000.0,
        sound_speed: 20.0,
        solid_offset: 0.11 * SPACING,
        solid_stretch: 1.1,
        slope_offset: 0.05 * SPACING,
        exponent: 7.0,
        viscosity: 0.01,
        artificial_viscosity: 0.1,
        density_diffusion: 0.1,
        surface_tension: 0.0,
        wall_friction: 1.0,
        cfl_factor: 0.3,
        max_dt: 0.005,
        min_dt: 1e-7,
        closed: 0b111111,
        clamp_pressure: 0,
        approach_damping_factor: 1.0,
        tolerance: 0.001,
        max_iterations: 5,
        compressibility: 2e-5,
        relaxation: 0.5,
        longest_motion: 0.5,
        pressure_factor: 0.9,
        lattice_moment: 0.95,
        surface_completion: 0.24,
        implicit_viscosity: 0.02,
        viscous_factor: 0.02 * SPACING.powi(3) * 525.0
            / (std::f32::consts::PI * (support_ratio * SPACING).powi(5)),
        viscous_tolerance: 0.01,
        most_viscous_iterations: 6,
        ..bytemuck::Zeroable::zeroed()
    }
}

pub fn state(particles: usize) -> StepState {
    StepState {
        dt: 4e-4,
        stable_dt: 5e-4,
        time: 0.7,
        remaining: 0.01,
        done: 0,
        run_count: particles as u32,
        steps: 3,
        too_small: 0,
        max_speed: 1.0,
        max_acceleration: 9.0,
        density_error: 0.01,
        frame_duration: 0.02,
        iterations: 7,
        most_iterations: 3,
        residual: 0.0002,
        compression: 0.004,
        viscous_iterations: 9,
        most_viscous_iterations: 4,
        viscous_residual: 0.003,
        frame_start: 0.69,
        body_speed: 0.0,
    }
}

/// Points in a box: everywhere, concentrated at walls, edges and corners, exactly on them, and duplicates.
pub fn points(params: &Params, n: usize) -> Vec<Vec3> {
    let (min, max) = (params.domain_min, params.domain_max);
    let inside = |i: usize| Vec3::new(unit(3 * i), unit(3 * i + 1), unit(3 * i + 2));
    let mut points: Vec<Vec3> = (0..n).map(|i| min + (max - min) * inside(i)).collect();
    for (i, x) in points.iter_mut().enumerate().take(n / 6) {
        // Moved towards one, two or three sides, to less than one and a half spacings.
        for axis in (0..3).filter(|axis| i >> axis & 1 == 1 || i % 3 == *axis) {
            let away = 1.5 * SPACING * unit(7 * i + axis + 100_000);
            x[axis] = if i & 8 == 0 { min[axis] + away } else { max[axis] - away };
        }
    }
    let corners =
        [min, max, min.with_x(max.x), min.with_x(0.0), max.with_y(0.2), min.with_z(0.4).with_y(0.25)];
    points.splice(0..6, corners);
    // In a corner where the solid of the third side barely reaches the support: its integral is a difference near zero.
    for i in 0..60 {
        let depth = (params.support_radius - if i % 2 == 0 { 0.0 } else { params.solid_offset })
            * (1.0 - 1e-7 * (1 << (i / 3)) as f32);
        let mut x = Vec3::splat(0.14 * SPACING + 1e-4 * i as f32);
        x[i % 3] = depth;
        points[n / 2 + 8 + i] = min + x;
    }
    for i in (20..n / 2).step_by(50) {
        points[i] = points[i + 1];
    }
    points
}

impl World {
    /// A cloud of about `n` particles, a few of them dead.
    pub fn new(params: Params, n: usize) -> Self {
        Self::with_slices(params, n, 4)
    }

    /// The same in cubes with this many slices.
    pub fn with_slices(params: Params, n: usize, slices: u32) -> Self {
        Self::of_points(params, &points(&params, n), slices)
    }

    /// Particles on the borders of cells, and neighbours whose distance along an axis is the support radius up to rounding.
    pub fn on_borders(params: Params, slices: u32) -> Self {
        let grid = Grid::new(params.domain_min, params.domain_max, params.support_radius).unwrap();
        let size = grid.size();
        let mut points = Vec::new();
        for i in slices..=size.x * slices - slices {
            for (j, k) in (1..size.y).flat_map(|j| (1..size.z).map(move |k| (j, k))) {
                let cubes = Vec3::new(i as f32 / slices as f32, j as f32, k as f32);
                points.push(grid.origin + cubes / grid.cells_per_metre);
            }
        }
        let near = points.iter().step_by(7).enumerate().map(|(n, &x)| {
            let factor = 1.0 + 1e-6 * [-3.0, -1.0, 0.0, 1.0, 3.0][n % 5];
            x + Vec3::AXES[n % 3] * params.support_radius * factor
        });
        points.extend(near.collect::<Vec<_>>());
        points.retain(|x| x.cmpge(params.domain_min).all() && x.cmple(params.domain_max).all());
        Self::of_points(params, &points, slices)
    }

    fn of_points(params: Params, points: &[Vec3], slices: u32) -> Self {
        let grid = Grid::new(params.domain_min, params.domain_max, params.support_radius)
            .and_then(|grid| grid.with_slices(slices))
            .unwrap();
        let n = points.len();
        let mut positions: Vec<Vec4> = points.iter().map(|x| x.extend(0.0)).collect();
        let dead = [
            Vec4::new(f32::NAN, 0.1, 0.2, DEAD_NON_FINITE),
            Vec4::new(9.0, 9.0, 9.0, DEAD_ESCAPED),
            params.domain_min.extend(DEAD_NON_FINITE),
        ];
        positions.splice(n / 2..n / 2, dead);
        let n = positions.len();
        let mut ids: Vec<u32> = (0..n as u32).map(|i| 3 * i + 1).collect();
        // Ids unrelated to the indices.
        for i in 0..n {
            ids.swap(i, testing::noise(i as u32 + 77) as usize % n);
        }
        let mut order: Vec<usize> = (0..n).collect();
        let cell = |p: Vec4| if p.w == 0.0 { grid.cell_of(p.xyz()) } else { grid.cell_count };
        order.sort_by_key(|&i| (cell(positions[i]), ids[i]));
        let sorted: Vec<Vec4> = order.iter().map(|&i| positions[i]).collect();
        let starts = (0..=grid.cell_count + 1).map(|c| sorted.partition_point(|&p| cell(p) < c) as u32);
        let signed = |i: usize, k: usize| 2.0 * unit(5 * i + k + 50_000) - 1.0;
        let velocities = |i: usize| {
            Vec3::new(signed(i, 0), signed(i, 1), signed(i, 2)).extend(1000.0 + 60.0 * signed(i, 3))
        };
        let densities = |i: usize| Vec2::new(1000.0 + 100.0 * signed(i, 4), 2e4 * (signed(i, 5) + 0.7));
        Self {
            params: Params { particle_count: n as u32, ..params },
            grid,
            state: state(n),
            cell_start: starts.collect(),
            positions: sorted.clone(),
            velocities: (0..n).map(velocities).collect(),
            ids: order.iter().map(|&i| ids[i]).collect(),
            densities: (0..n).map(densities).collect(),
            normals: (0..n)
                .map(|i| Vec3::new(signed(i, 6), signed(i, 7), signed(i, 8)).extend(0.0))
                .collect(),
        }
    }

    /// Number of active particles.
    pub fn active(&self) -> usize {
        self.cell_start[self.grid.cell_count as usize] as usize
    }

    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// Unsorted particles: the sorted ones in another order.
    pub fn shuffled(&self) -> Shuffled {
        let n = self.len();
        let mut order: Vec<u32> = (0..n as u32).collect();
        for i in 0..n {
            order.swap(i, testing::noise(i as u32 + 4242) as usize % n);
        }
        Shuffled { order }
    }
}

/// The particles before the sort.
pub struct Shuffled {
    /// The sorted index of each particle.
    pub order: Vec<u32>,
}

impl Shuffled {
    /// The cell counts after counting, and the cells of the particles.
    pub fn cell_counts(&self, world: &World) -> (Vec<u32>, Vec<u32>) {
        let starts = &world.cell_start;
        let cell = |&k: &u32| starts.partition_point(|&start| start <= k) as u32 - 1;
        let cells: Vec<u32> = self.order.iter().map(cell).collect();
        let mut cell_counts: Vec<u32> = starts.windows(2).map(|bounds| bounds[1] - bounds[0]).collect();
        cell_counts.extend(&cells);
        (cell_counts, cells)
    }

    pub fn of<T: Copy>(&self, sorted: &[T]) -> Vec<T> {
        self.order.iter().map(|&k| sorted[k as usize]).collect()
    }
}
