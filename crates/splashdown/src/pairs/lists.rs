//! Lists of the neighbours of every particle with a vector for each, such as the gradient of the kernel, for passes
//! that visit the same neighbours many times in a step.
//!
//! A visit of the candidates tests four times as many particles as there are neighbours, and computes a square root for
//! each. To make a list costs as much as two of these visits, and a visit of a list costs less than half of one. A
//! neighbour takes 16 bytes: three numbers and its index.

use std::marker::PhantomData;
use std::ops::Range;

use glam::{Mat4, Vec3, Vec4};
use rayon::prelude::*;

use super::Sorted;
use super::candidates::{Candidates, Region};
use super::columns::Columns;
use super::near::Near;
use super::particles::{Outputs, pieces};
use super::vector::{difference, dot, scaled, splat};
use crate::boundary::Images;
use crate::kernel::Kernel;
use crate::simd::{BLOCK, Lanes, Leaf, Register, Simd, run_with};

/// Number of lists, which is that of tasks.
const LISTS: usize = 64;

/// Bits of the index of a neighbour. Above them are three bits, the axes of the reflection of an image.
pub(super) const INDEX_BITS: u32 = 27;

/// A bit that makes the index, which is stored with three numbers, a normal number: arithmetic with subnormal ones can take
/// a hundred times as long.
const NORMAL: u32 = 1 << 30;

/// More particles could make it infinite.
const MOST: usize = 15 << 23;

/// The neighbours of the particles in some rows of cells.
#[derive(Default)]
struct List {
    /// For each particle, the ends of its neighbours and of its images in the list.
    ends: Vec<[u32; 2]>,
    /// The vector of each neighbour, and the bits of its index as the fourth component.
    neighbours: Vec<Vec4>,
}

impl List {
    fn near(&self, range: Range<usize>) -> Near<'_> {
        Near::new(&self.neighbours[range])
    }
}

/// A function of the distance that a list contains as a factor on the difference of the positions.
pub(crate) trait Radial: Send + Sync + 'static {
    /// The factor at a distance of q support radii; zero beyond the support.
    fn factor<V: Lanes>(q: V) -> V;
}

/// The gradient of a kernel times the fifth power of the support radius.
impl<K: Kernel> Radial for K {
    #[inline(always)]
    fn factor<V: Lanes>(q: V) -> V {
        K::g(q)
    }
}

/// Lists of neighbours, and what they were made from.
pub(crate) struct NeighbourLists<R> {
    lists: Vec<List>,
    /// The positions that the lists belong to.
    positions: Vec<Vec4>,
    /// Support radius and images that they belong to.
    made_for: Option<(f32, Images)>,
    factor: PhantomData<R>,
}

impl<R> Default for NeighbourLists<R> {
    fn default() -> Self {
        Self { lists: Vec::new(), positions: Vec::new(), made_for: None, factor: PhantomData }
    }
}

impl<R: Radial> NeighbourLists<R> {
    /// The lists for these particles; makes them unless they exist.
    pub fn of(&mut self, sorted: Sorted<'_>) -> &Self {
        self.of_with(Simd::in_use(), sorted)
    }

    pub(super) fn of_with(&mut self, simd: Simd, sorted: Sorted<'_>) -> &Self {
        assert!(sorted.active_count() <= MOST, "{} particles are more than {MOST}", sorted.active_count());
        let positions = &sorted.positions[..sorted.active_count()];
        let made_for = Some((sorted.support_radius, sorted.images));
        let bits = |positions| bytemuck::cast_slice::<Vec4, u8>(positions);
        if self.made_for != made_for || bits(&self.positions) != bits(positions) {
            self.make(simd, sorted);
            self.positions.clear();
            self.positions.extend_from_slice(positions);
            self.made_for = made_for;
        }
        self
    }

    fn make(&mut self, simd: Simd, sorted: Sorted<'_>) {
        let columns = &Columns::new(sorted.active_count(), |j| {
            let [x, y, z, _] = sorted.positions[j].to_array();
            [x, y, z, f32::from_bits(NORMAL | j as u32)]
        });
        // The results are stored in the lists.
        let cells = pieces(sorted, Nothing, least(sorted));
        // Lists that are not needed now keep their memory.
        self.lists.resize_with(self.lists.len().max(cells.len()), List::default);
        self.lists.par_iter_mut().zip(cells).with_max_len(1).for_each_init(
            || [Candidates::new(), Candidates::new()],
            |candidates, (list, (cells, _))| {
                list.ends.clear();
                list.neighbours.clear();
                for cell in cells {
                    let cell = Cell::<R> { sorted, columns, candidates, cell, list, factor: PhantomData };
                    run_with(simd, cell);
                }
            },
        );
    }

    /// Computes the results of all particles from their index, their neighbours, and their images that are neighbours. All
    /// indices of neighbours are below the number of active particles.
    pub fn for_each<T>(
        &self,
        sorted: Sorted<'_>,
        outputs: impl Outputs<T>,
        result: impl Fn(usize, [Near<'_>; 2]) -> T + Sync,
    ) {
        let pieces = pieces(sorted, outputs, least(sorted));
        self.lists.par_iter().zip(pieces).with_max_len(1).for_each(|(list, (cells, mut outputs))| {
            let first = sorted.cell_start[cells.start] as usize;
            let mut begin = 0;
            for (k, ends) in list.ends.iter().enumerate() {
                let [middle, end] = ends.map(|end| end as usize);
                outputs.put(k, result(first + k, [list.near(begin..middle), list.near(middle..end)]));
                begin = end;
            }
        });
    }
}

/// Particles per list. Equal numbers keep the sizes of the lists similar from step to step: memory that a list grows into
/// is new, and the system would have to clear it.
fn least(sorted: Sorted<'_>) -> usize {
    (sorted.active_count() / LISTS).max(1)
}

/// No results.
struct Nothing;

impl Outputs<()> for Nothing {
    fn split_at(self, _: usize) -> (Self, Self) {
        (Self, Self)
    }

    fn put(&mut self, _: usize, (): ()) {}
}

/// One cell, whose neighbours are appended to a list.
struct Cell<'a, R> {
    sorted: Sorted<'a>,
    /// Position and index.
    columns: &'a Columns<4>,
    /// Particles and images.
    candidates: &'a mut [Candidates<4>; 2],
    cell: usize,
    list: &'a mut List,
    factor: PhantomData<R>,
}

impl<R: Radial> Leaf for Cell<'_, R> {
    #[inline(always)]
    fn run<V: Register>(self) {
        let Self { sorted, columns, candidates, cell, list, .. } = self;
        let particles = sorted.run(cell, 1);
        if particles.is_empty() {
            return;
        }
        let support = sorted.support_radius;
        let targets = sorted.positions[particles.clone()].iter().map(|p| p.truncate());
        let region = Region::around(targets, support);
        let runs = sorted.runs_around(cell);
        let reflections = sorted.images.near(region.low.into(), region.high.into(), support);
        let [particles_near, images_near] = candidates;
        particles_near.pack::<V>(columns, &runs, &region);
        images_near.pack_only_images::<V>(columns, &runs, &region, reflections, |by, indices| {
            let axes = by.sign.cmplt(Vec3::ZERO).bitmask();
            for index in indices {
                *index = f32::from_bits(index.to_bits() | axes << INDEX_BITS);
            }
        });
        let most = particles_near.columns()[0].len() + images_near.columns()[0].len();
        let List { ends, neighbours } = list;
        neighbours.reserve(particles.len() * most + BLOCK);
        for i in particles {
            let x = splat::<V>(sorted.positions[i]);
            append::<R, V>(x, support, particles_near.columns(), neighbours);
            let middle = neighbours.len();
            append::<R, V>(x, support, images_near.columns(), neighbours);
            ends.push([middle as u32, neighbours.len() as u32]);
        }
    }
}

/// Appends those of the candidates that are within the support radius of a point. There must be room for all of them and a
/// block.
#[inline(always)]
fn append<R: Radial, V: Register>(x: [V; 3], support: f32, from: [&[f32]; 4], neighbours: &mut Vec<Vec4>) {
    let (reach2, inverse) = (V::splat(support * support), 1.0 / support);
    let mut columns = [[0.0_f32; BLOCK]; 4];
    for k in (0..from[0].len()).step_by(V::WIDTH) {
        let mut values = [V::splat(0.0); 4];
        for (value, column) in values.iter_mut().zip(&from) {
            // SAFETY: the length is a multiple of the block, and the width divides the block.
            *value = unsafe { V::load(column.as_ptr().add(k)) };
        }
        let [x_j, y_j, z_j, index] = values;
        let d = difference(x, [x_j, y_j, z_j]);
        let r2 = dot(d, d);
        // Without the particle itself.
        let near = r2.less_bits(reach2) & V::splat(0.0).less_bits(r2);
        if near == 0 {
            continue;
        }
        let [gx, gy, gz] = scaled(R::factor(r2.sqrt() * inverse), d);
        for (values, column) in [gx, gy, gz, index].into_iter().zip(&mut columns) {
            // SAFETY: a block is at least as wide as a register.
            unsafe { values.compress(near).store(column.as_mut_ptr()) };
        }
        let (count, begin) = (near.count_ones() as usize, neighbours.len());
        assert!(begin + BLOCK <= neighbours.capacity());
        let quads = columns.each_ref().map(|column| column.as_chunks::<4>().0);
        for quad in 0..count.div_ceil(4) {
            let [gx, gy, gz, index] = quads.map(|column| Vec4::from(column[quad]));
            let rows = Mat4::from_cols(gx, gy, gz, index).transpose();
            // SAFETY: there is room for a block, as tested above.
            unsafe { neighbours.as_mut_ptr().add(begin + 4 * quad).cast::<Mat4>().write(rows) };
        }
        // SAFETY: this many have been written.
        unsafe { neighbours.set_len(begin + count) };
    }
}
