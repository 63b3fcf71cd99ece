//! Per row of cells: gather a cell's neighbourhood once, then sum over it for each of the cell's particles.

use glam::{Vec3, Vec4};
use rayon::prelude::*;
use splashdown_gpu::{CpuWork, Slot};

use super::super::gather::{Columns, Gathered, LANES, dispatched};
use super::super::params::Lattice;
use super::super::parts::by_starts;
use super::super::spline::{positive, spline};
use crate::cells::Grid;

pub(super) fn volume(_: CpuWork, slots: &mut [Slot<'_>]) {
    let [lattice, grid, cell_start, positions, samples, crowding] = slots else { unreachable!() };
    let (lattice, grid) = (lattice.get::<Lattice>(), grid.get::<Grid>());
    let (cell_start, positions) = (cell_start.read::<u32>(), positions.read::<Vec4>());
    let size = [grid.size_x, grid.size_y, grid.size_z];
    let width = grid.size_x as usize;
    if width == 0 {
        return;
    }
    let living = (cell_start[grid.cell_count as usize] as usize).min(lattice.particle_capacity as usize);
    let rows: Vec<u32> = cell_start[..=grid.cell_count as usize].iter().step_by(width).copied().collect();
    let samples = by_starts(&mut samples.write::<Vec4>()[..living], &rows);
    let crowding = by_starts(&mut crowding.write::<f32>()[..living], &rows);
    let occupied: Vec<_> = samples
        .into_iter()
        .zip(crowding)
        .enumerate()
        .filter(|(_, (samples, _))| !samples.is_empty())
        .collect();
    occupied.into_par_iter().for_each_init(Gathered::default, |near, (row, (samples, crowding))| {
        let starts = &cell_start[row * width..=(row + 1) * width];
        for (x, range) in starts.windows(2).enumerate().filter(|(_, range)| range[0] < range[1]) {
            let cell = [x as u32, row as u32 % grid.size_y, row as u32 / grid.size_y];
            let low = grid.origin + Vec3::from(cell.map(|c| c as f32)) * grid.cell_size;
            // A little beyond the support, so that rounding cannot leave a neighbour out; what is farther
            // weighs nothing.
            let margin = 1.001 * lattice.support_radius;
            let bounds = (low - margin, low + grid.cell_size + margin);
            // Cells are no narrower than the support, so these hold all neighbours.
            let cells =
                (cell.map(|c| c.saturating_sub(1)), std::array::from_fn(|i| (cell[i] + 1).min(size[i] - 1)));
            near.fill_from(&grid, cells, cell_start, positions, &[], bounds);
            let own = range[0] as usize..range[1].min(living as u32) as usize;
            let place = own.start - starts[0] as usize;
            let samples = &mut samples[place..place + own.len()];
            let crowding = &mut crowding[place..place + own.len()];
            sum_over(near.columns(), &positions[own], lattice.inverse_support, samples, crowding);
        }
    });
}

dispatched! {
    /// For each particle the sums of the spline and of `1 - r^2 / H^2` over what was gathered, in eight
    /// lanes.
    fn sum_over(
        near: Columns<'_>,
        particles: &[Vec4],
        inverse_support: f32,
        samples: &mut [Vec4],
        crowding: &mut [f32],
    ) {
        let inverse2 = inverse_support * inverse_support;
        for ((p, sample), crowding) in particles.iter().zip(samples).zip(crowding) {
            let (mut sum, mut neighbours) = ([0.0_f32; LANES], [0.0_f32; LANES]);
            let columns = near.x.as_chunks().0.iter().zip(near.y.as_chunks().0).zip(near.z.as_chunks().0);
            for ((x, y), z) in columns {
                let (x, y, z): (&[f32; LANES], &[f32; LANES], &[f32; LANES]) = (x, y, z);
                for lane in 0..LANES {
                    let (dx, dy, dz) = (x[lane] - p.x, y[lane] - p.y, z[lane] - p.z);
                    let r2 = dx * dx + dy * dy + dz * dz;
                    sum[lane] += spline(r2.sqrt() * inverse_support);
                    neighbours[lane] += positive(1.0 - r2 * inverse2);
                }
            }
            *sample = p.truncate().extend(1.0 / sum.iter().sum::<f32>());
            // The particle itself is not its neighbour.
            *crowding = neighbours.iter().sum::<f32>() - 1.0;
        }
    }
}
