use glam::{Vec3, Vec4};
use rayon::prelude::*;

use super::FieldBindings;
use super::nodes::{LAYER, N, Nodes, ends};
use crate::kernel::{CubicSpline, Kernel};
use crate::pairs::{self, BoxPass, Sorted};
use crate::simd::Register;
use crate::surface::params::{Lattice, NODES, ROWS};

/// Factor on the square of the support radius against rounding: rows beyond it contribute exactly
/// zero, so that the result does not depend on the number of rows per register.
const MARGIN: f32 = 1.0001;

pub(super) fn field(buffers: FieldBindings<'_>) {
    let FieldBindings { lattice, grid, status, block_list, cell_start, samples, field_values, signs } =
        buffers;
    let blocks = status.blocks as usize;
    let values = field_values.as_chunks_mut::<NODES>().0;
    let signs = signs.as_chunks_mut::<ROWS>().0;
    let outputs = values[..blocks].par_iter_mut().zip(&mut signs[..blocks]);
    let sorted =
        Sorted::new(lattice.support_radius, grid, cell_start, samples).with_images(lattice.walls().images());
    pairs::for_each_box(sorted, outputs, &Field { nodes: Nodes { lattice, blocks: block_list }, samples });
}

struct Field<'a> {
    nodes: Nodes<'a>,
    samples: &'a [Vec4],
}

impl<'a> BoxPass<4> for Field<'a> {
    type Output = (&'a mut [f32; NODES], &'a mut [u32; ROWS]);

    #[inline(always)]
    fn load(&self, j: usize) -> [f32; 4] {
        self.samples[j].to_array()
    }

    fn corners(&self, i: usize) -> [Vec3; 2] {
        self.nodes.corners(i)
    }

    #[inline(always)]
    fn visit<V: Register>(&self, i: usize, near: [&[f32]; 4], (values, signs): &mut Self::Output) {
        values.fill(0.0);
        add::<V>(near, &self.nodes.folded_axes(i), self.nodes.lattice, values);
        self.nodes.set_signs(i, values, signs);
    }
}

/// Adds every particle to the nodes of a block, whose coordinates `axes` gives per axis.
#[inline(always)]
fn add<V: Register>(
    [x, y, z, volume]: [&[f32]; 4],
    axes: &[[f32; N]; 3],
    lattice: &Lattice,
    values: &mut [f32; NODES],
) {
    let support2 = MARGIN * lattice.support_radius * lattice.support_radius;
    // A register holds a part of a row of eight nodes, one row, or two rows.
    let rows = V::WIDTH.div_ceil(N);
    let [first_x, last_x] = ends(axes[0]);
    for (((&x, &y), &z), &volume) in x.iter().zip(y).zip(z).zip(volume) {
        let square = |axis: &[f32; N], centre: f32| axis.map(|a| (a - centre) * (a - centre));
        let (dx2, dy2, dz2) = (square(&axes[0], x), square(&axes[1], y), square(&axes[2], z));
        let outside = (first_x - x).max(x - last_x).max(0.0);
        // A row at a squared distance of at least this in y and z has no node within reach.
        let limit = support2 - outside * outside;
        let nearest_dy2 = dy2.iter().copied().fold(f32::MAX, f32::min);
        let mut layer = [0.0; LAYER];
        for (row, dy2) in layer.as_chunks_mut::<N>().0.iter_mut().zip(dy2) {
            *row = dx2.map(|dx2| dx2 + dy2);
        }
        let volume = V::splat(volume);
        for (dz2, values) in dz2.into_iter().zip(values.as_chunks_mut::<LAYER>().0) {
            if nearest_dy2 + dz2 >= limit {
                continue;
            }
            for row in (0..N).step_by(rows) {
                if dy2[row..row + rows].iter().all(|dy2| dy2 + dz2 >= limit) {
                    continue;
                }
                for node in (N * row..N * (row + rows)).step_by(V::WIDTH) {
                    // SAFETY: `node + WIDTH` is at most the number of nodes of a layer.
                    let r2 = unsafe { V::load(layer.as_ptr().add(node)) } + dz2;
                    let w = CubicSpline::w(r2.sqrt() * lattice.inverse_support);
                    // SAFETY: as above.
                    unsafe {
                        let at = values.as_mut_ptr().add(node);
                        (V::load(at) + volume * w).store(at);
                    }
                }
            }
        }
    }
}
