use glam::{Vec3, Vec4};
use rayon::prelude::*;

use super::StretchedFieldBindings;
use crate::boundary::Reflection;
use crate::kernel::{CubicSpline, Kernel};
use crate::pairs::{self, BoxPass, Sorted, reflected_matrix, reflected_point};
use crate::simd::Register;
use crate::surface::field::nodes::{LAYER, N, Nodes, ends};
use crate::surface::params::{NODES, ROWS};

/// Factor on the squares of the sides of the box around an ellipsoid against rounding: nodes beyond it contribute exactly zero.
const MARGIN: f32 = 1.0001;

pub(super) fn stretched_field(buffers: StretchedFieldBindings<'_>) {
    let StretchedFieldBindings {
        lattice,
        grid,
        status,
        block_list,
        cell_start,
        samples,
        kernel_matrices,
        field_values,
        signs,
    } = buffers;
    let blocks = status.blocks as usize;
    let values = field_values.as_chunks_mut::<NODES>().0;
    let signs = signs.as_chunks_mut::<ROWS>().0;
    let outputs = values[..blocks].par_iter_mut().zip(&mut signs[..blocks]);
    let sorted =
        Sorted::new(lattice.search_reach, grid, cell_start, samples).with_images(lattice.walls().images());
    let nodes = Nodes { lattice, blocks: block_list };
    let matrices = kernel_matrices.as_chunks().0;
    pairs::for_each_box(sorted, outputs, &Field { nodes, sorted, samples, matrices });
}

struct Field<'a> {
    nodes: Nodes<'a>,
    sorted: Sorted<'a>,
    samples: &'a [Vec4],
    matrices: &'a [[Vec4; 2]],
}

/// Above this iso level, the default, a block is evaluated in any case. Inside the fluid the field is about 1. It is 0.68 at the
/// place of a missing particle, and at least 0.61 between two, where their neighbours still count as inside because the lattice
/// is too dense.
const INTERIOR_ISO: f32 = 0.6;

impl Field<'_> {
    /// True if all particles in the cells that a block can reach are inside the fluid.
    fn is_interior(&self, i: usize) -> bool {
        let lattice = self.nodes.lattice;
        let [low, high] = self.nodes.corners(i);
        let reach = lattice.search_reach;
        let mut particles = self.sorted.rows_near([low - reach, high + reach]).flatten().peekable();
        lattice.iso_level <= INTERIOR_ISO
            && particles.peek().is_some()
            && particles.all(|j| self.samples[j].w < 0.0)
    }
}

/// Columns: centre, weight, the matrix (xx, xy, xz, yy, yz, zz), and the square of a bound of the half-axes.
impl<'a> BoxPass<11> for Field<'a> {
    type Output = (&'a mut [f32; NODES], &'a mut [u32; ROWS]);
    const REACH2: Option<usize> = Some(10);

    #[inline(always)]
    fn load(&self, j: usize) -> [f32; 11] {
        let [x, y, z, weight] = self.samples[j].to_array();
        let [first, second] = self.matrices[j];
        [x, y, z, weight.abs(), first.x, first.y, first.z, first.w, second.x, second.y, second.z]
    }

    #[inline(always)]
    fn reflect<V: Register>(&self, by: &Reflection, values: [V; 11]) -> [V; 11] {
        let [x, y, z, weight, xx, xy, xz, yy, yz, zz, reach2] = values;
        let [x, y, z] = reflected_point(by, [x, y, z]);
        let [xx, xy, xz, yy, yz, zz] = reflected_matrix(by, [xx, xy, xz, yy, yz, zz]);
        [x, y, z, weight, xx, xy, xz, yy, yz, zz, reach2]
    }

    fn corners(&self, i: usize) -> [Vec3; 2] {
        self.nodes.corners(i)
    }

    fn shortcut(&self, i: usize, (values, signs): &mut Self::Output) -> bool {
        let is_interior = self.is_interior(i);
        if is_interior {
            values.fill(1.0);
            self.nodes.set_signs(i, values, signs);
        }
        is_interior
    }

    #[inline(always)]
    fn visit<V: Register>(&self, i: usize, near: [&[f32]; 11], (values, signs): &mut Self::Output) {
        values.fill(0.0);
        add::<V>(near, &self.nodes.folded_axes(i), values);
        self.nodes.set_signs(i, values, signs);
    }
}

/// Adds every ellipsoid to the nodes of a block, whose coordinates `axes` gives per axis.
#[inline(always)]
fn add<V: Register>(near: [&[f32]; 11], axes: &[[f32; N]; 3], values: &mut [f32; NODES]) {
    // A register holds a part of a row of eight nodes, one row, or two rows.
    let rows = V::WIDTH.div_ceil(N);
    let corners = axes.map(ends);
    let (zero, one) = (V::splat(0.0), V::splat(1.0));
    let xs: [f32; LAYER] = std::array::from_fn(|node| axes[0][node % N]);
    let ys: [f32; LAYER] = std::array::from_fn(|node| axes[1][node / N]);
    let count = near[0].len();
    let near = near.map(|column| &column[..count]);
    for j in 0..count {
        let [x, y, z, weight, xx, xy, xz, yy, yz, zz, _] = near.map(|column| column[j]);
        // The squares of the half-sides of the box around the ellipsoid are cofactors of the matrix divided by its
        // determinant. At the padding the determinant is zero.
        let cofactors = [yy * zz - yz * yz, xx * zz - xz * xz, xx * yy - xy * xy];
        let determinant = xx * cofactors[0] - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
        let is_near = |[low, high]: [f32; 2], centre: f32, cofactor: f32| {
            let outside = (low - centre).max(centre - high).max(0.0);
            outside * outside * determinant < MARGIN * cofactor
        };
        if !(is_near(corners[0], x, cofactors[0])
            && is_near(corners[1], y, cofactors[1])
            && is_near(corners[2], z, cofactors[2]))
        {
            continue;
        }
        let [dy, dz] = [(1, y), (2, z)].map(|(axis, centre)| axes[axis].map(|a| a - centre));
        let [reach_y2, reach_z2] = [1, 2].map(|axis| MARGIN * cofactors[axis] / determinant);
        for row in (0..N).step_by(rows) {
            if dy[row..row + rows].iter().all(|dy| dy * dy >= reach_y2) {
                continue;
            }
            for node in (N * row..N * (row + rows)).step_by(V::WIDTH) {
                // SAFETY: `node + WIDTH` is at most the number of nodes of a layer.
                let (dx, dy) =
                    unsafe { (V::load(xs.as_ptr().add(node)) - x, V::load(ys.as_ptr().add(node)) - y) };
                // q^2 = base + (slope + zz dz) dz
                let base = (dx * xx + dy * (2.0 * xy)) * dx + dy * dy * yy;
                let slope = dx * (2.0 * xz) + dy * (2.0 * yz);
                for (dz, values) in dz.into_iter().zip(values.as_chunks_mut::<LAYER>().0) {
                    if dz * dz >= reach_z2 {
                        continue;
                    }
                    let q2 = base + (slope + zz * dz) * dz;
                    if q2.less_bits(one) == 0 {
                        continue;
                    }
                    let w = CubicSpline::w(q2.max(zero).sqrt());
                    // SAFETY: as above.
                    unsafe {
                        let at = values.as_mut_ptr().add(node);
                        (V::load(at) + w * weight).store(at);
                    }
                }
            }
        }
    }
}
