use glam::{Vec3, Vec4};
use rayon::prelude::*;
use splashdown_gpu::{CpuWork, Slot};

use super::super::gather::{Columns, Gathered, dispatched};
use super::super::params::{Lattice, NODES, ROWS, SIDE, Status};
use super::super::spline::spline;
use crate::cells::Grid;

const N: usize = SIDE as usize;

pub(super) fn field(_: CpuWork, slots: &mut [Slot<'_>]) {
    let [lattice, grid, status, list, cell_start, samples, values, signs] = slots else { unreachable!() };
    let (lattice, grid) = (lattice.get::<Lattice>(), grid.get::<Grid>());
    let blocks = status.get::<Status>().blocks as usize;
    let (cell_start, samples) = (cell_start.read::<u32>(), samples.read::<Vec4>());
    let outputs = values
        .write::<f32>()
        .par_chunks_exact_mut(NODES)
        .zip(signs.write::<u32>().par_chunks_exact_mut(ROWS));
    list.read::<u32>()[..blocks].par_iter().zip(outputs).for_each_init(
        || (Gathered::default(), [[0.0; N]; ROWS]),
        |(near, rows), (&block, (values, signs))| {
            let first = lattice.block_place(block).map(|place| place as u32 * SIDE);
            let axes: [[f32; N]; 3] = std::array::from_fn(|axis| {
                std::array::from_fn(|i| lattice.coordinate(axis, first[axis] + i as u32))
            });
            let low = Vec3::from(axes.map(|axis| axis[0])) - lattice.support_radius;
            let high = Vec3::from(axes.map(|axis| axis[N - 1])) + lattice.support_radius;
            near.fill(&grid, cell_start, samples, &[], low, high);
            add(near.columns(), &axes, lattice.support_radius, lattice.inverse_support, rows);
            values.copy_from_slice(rows.as_flattened());
            for (signs, row) in signs.iter_mut().zip(rows.iter()) {
                *signs = (0..N).fold(0, |bits, i| bits | (u32::from(row[i] >= lattice.iso_level) << i));
            }
        },
    );
}

dispatched! {
    /// The sum over all gathered particles at a block's nodes, whose coordinates `axes` gives per axis.
    fn add(
        near: Columns<'_>,
        axes: &[[f32; N]; 3],
        support: f32,
        inverse_support: f32,
        rows: &mut [[f32; N]; ROWS],
    ) {
        *rows = [[0.0; N]; ROWS];
        let support2 = support * support;
        for (((&x, &y), &z), &volume) in near.x.iter().zip(near.y).zip(near.z).zip(near.w) {
            let square = |axis: &[f32; N], center: f32| -> [f32; N] {
                std::array::from_fn(|i| (axis[i] - center) * (axis[i] - center))
            };
            let (dx2, dy2, dz2) = (square(&axes[0], x), square(&axes[1], y), square(&axes[2], z));
            // Rows farther than this in y and z have no node in reach.
            let outside = (axes[0][0] - x).max(x - axes[0][N - 1]).max(0.0);
            let limit = support2 - outside * outside;
            for (dz2, rows) in dz2.iter().zip(rows.as_chunks_mut::<N>().0) {
                let mut near_rows = 0_u32;
                for (i, dy2) in dy2.iter().enumerate() {
                    near_rows |= u32::from(dy2 + dz2 < limit) << i;
                }
                while near_rows != 0 {
                    let y = near_rows.trailing_zeros() as usize;
                    near_rows &= near_rows - 1;
                    let d2 = dy2[y & 7] + dz2;
                    let row = &mut rows[y & 7];
                    for i in 0..N {
                        row[i] += volume * spline((dx2[i] + d2).sqrt() * inverse_support);
                    }
                }
            }
        }
    }
}
