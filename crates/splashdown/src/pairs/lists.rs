//! Lists of the neighbours of every particle with a factor for each, such as that of the gradient of the kernel, for passes
//! that visit the same neighbours many times in a step.
//!
//! A visit of the candidates tests four times as many particles as there are neighbours, and computes a square root for
//! each. To make a list costs as much as two of these visits, and a visit of a list costs less than half of one. A
//! neighbour takes 8 bytes: the factor and its index. Reading the list is what a visit waits for, so that subtracting the
//! positions again costs less than reading their difference. Images behind walls are few and take 16 bytes: the vector, and
//! bits for index and reflection.

use std::marker::PhantomData;
use std::ops::Range;

use glam::{Mat4, Vec3, Vec4};
use rayon::prelude::*;

use super::Sorted;
use super::candidates::{Candidates, Region};
use super::columns::Columns;
use super::near::{Link, Near, NearImages};
use super::particles::{Outputs, PairSum, pieces};
use super::vector::{difference, dot, scaled, splat};
use crate::boundary::{Images, Reflection};
use crate::kernel::Kernel;
use crate::simd::{BLOCK, Lanes, Leaf, Register, Simd, run_with};

/// Number of lists, up to rounding, which is that of tasks.
const LISTS: usize = 64;

/// Positions per task that compares them.
const CHUNK: usize = 1 << 14;

/// Bits of the index of a neighbour. Above them are three bits, the axes of the reflection of an image.
pub(super) const INDEX_BITS: u32 = 27;

/// A bit that makes the index of an image, which is stored with three numbers, a normal number: arithmetic with subnormal
/// ones can take a hundred times as long.
const NORMAL: u32 = 1 << 30;

/// More particles could make it infinite.
const MOST: usize = 15 << 23;

/// The neighbours of the particles in some rows of cells.
#[derive(Default)]
struct List {
    /// For each particle, the ends of its neighbours and of its images.
    ends: Vec<[usize; 2]>,
    neighbours: Vec<Link>,
    /// The vector of each image, and the bits of its index and its reflection as the fourth component.
    images: Vec<Vec4>,
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
    /// What else they belong to.
    made_for: Option<Conditions>,
    /// The registers of the sums.
    simd: Simd,
    factor: PhantomData<R>,
}

/// What lists depend on besides the positions: support radius, images, and the origin and the size of the grid.
type Conditions = (f32, Images, Vec3, [u32; 3]);

fn conditions(sorted: Sorted<'_>) -> Conditions {
    let Sorted { grid, support_radius, images, .. } = sorted;
    (support_radius, images, grid.origin, [grid.size_x, grid.size_y, grid.size_z])
}

/// Whether all bits are equal.
fn are_same(a: &[Vec4], b: &[Vec4]) -> bool {
    let bits = |positions| bytemuck::cast_slice::<Vec4, u8>(positions);
    let pairs = a.par_chunks(CHUNK).zip(b.par_chunks(CHUNK));
    a.len() == b.len() && pairs.all(|(a, b)| bits(a) == bits(b))
}

impl<R> Default for NeighbourLists<R> {
    fn default() -> Self {
        let (lists, positions, factor) = (Vec::new(), Vec::new(), PhantomData);
        Self { lists, positions, made_for: None, simd: Simd::Portable, factor }
    }
}

impl<R: Radial> NeighbourLists<R> {
    /// The lists for these particles; makes them unless they exist.
    pub fn of(&mut self, sorted: Sorted<'_>) -> &Self {
        self.of_with(Simd::in_use(), sorted)
    }

    pub(super) fn of_with(&mut self, simd: Simd, sorted: Sorted<'_>) -> &Self {
        let positions = &sorted.positions[..sorted.active_count()];
        if self.made_for != Some(conditions(sorted)) || !are_same(&self.positions, positions) {
            self.make_with(simd, sorted, Nothing, &NoSum { positions });
        }
        self
    }

    /// Makes the lists, and runs a pass over the neighbours in the same visit.
    pub fn make<const F: usize, const S: usize, P: ListedSum<F, S>>(
        &mut self,
        sorted: Sorted<'_>,
        outputs: impl Outputs<P::Output>,
        pass: &P,
    ) {
        self.make_with(Simd::in_use(), sorted, outputs, pass);
    }

    pub(super) fn make_with<const F: usize, const S: usize, P: ListedSum<F, S>>(
        &mut self,
        simd: Simd,
        sorted: Sorted<'_>,
        outputs: impl Outputs<P::Output>,
        pass: &P,
    ) {
        let count = sorted.active_count();
        assert!(count <= MOST, "{count} particles are more than {MOST}");
        let columns = &Columns::new(count, |j| pass.load(j));
        let pieces = pieces(sorted, outputs, least(sorted));
        // Lists that are not needed now keep their memory.
        self.lists.resize_with(self.lists.len().max(pieces.len()), List::default);
        self.lists.par_iter_mut().zip(pieces).with_max_len(1).for_each_init(
            || [Candidates::new(), Candidates::new(), Candidates::new()],
            |candidates, (list, (cells, outputs))| {
                list.ends.clear();
                list.neighbours.clear();
                list.images.clear();
                let factor = PhantomData::<R>;
                run_with(simd, Cells { sorted, columns, candidates, cells, list, outputs, pass, factor });
            },
        );
        self.positions.clear();
        self.positions.extend_from_slice(&sorted.positions[..count]);
        (self.made_for, self.simd) = (Some(conditions(sorted)), simd);
    }

    /// Computes the results of all particles from their index, their neighbours, and their images that are neighbours. All
    /// indices of neighbours are below the number of active particles.
    pub fn for_each<T>(
        &self,
        sorted: Sorted<'_>,
        outputs: impl Outputs<T>,
        result: impl Fn(usize, Near<'_>, NearImages<'_>) -> T + Sync,
    ) {
        let pieces = pieces(sorted, outputs, least(sorted));
        self.lists.par_iter().zip(pieces).with_max_len(1).for_each(|(list, (cells, mut outputs))| {
            let first = sorted.cell_start[cells.start] as usize;
            let mut begin = [0, 0];
            for (k, &ends) in list.ends.iter().enumerate() {
                let links = &list.neighbours[begin[0]..ends[0]];
                // SAFETY: the lists were made from particles below this number, with these registers.
                let near = unsafe { Near::new(first + k, links, self.positions.len(), self.simd) };
                outputs.put(k, result(first + k, near, NearImages::new(&list.images[begin[1]..ends[1]])));
                begin = ends;
            }
        });
    }
}

/// Particles per list. Equal numbers keep the sizes of the lists similar from step to step: memory that a list grows into
/// is new, and the system would have to clear it.
fn least(sorted: Sorted<'_>) -> usize {
    (sorted.active_count() / LISTS).max(1)
}

/// A pass that runs while lists are made. The last column must be the [place](Link::place_bits) of the particle.
pub(crate) trait ListedSum<const F: usize, const S: usize>: PairSum<F, S> {}

/// No sums.
struct NoSum<'a> {
    positions: &'a [Vec4],
}

impl PairSum<4, 0> for NoSum<'_> {
    type Output = ();

    #[inline(always)]
    fn load(&self, j: usize) -> [f32; 4] {
        let [x, y, z, _] = self.positions[j].to_array();
        [x, y, z, Link::place_bits(j)]
    }

    #[inline(always)]
    fn pair<V: Register>(&self, _: usize) -> impl Fn([V; 4]) -> [V; 0] {
        #[inline(always)]
        |_| []
    }

    #[inline(always)]
    fn finish(&self, _: usize, _: [f32; 0]) {}
}

impl ListedSum<4, 0> for NoSum<'_> {}

/// No results.
struct Nothing;

impl Outputs<()> for Nothing {
    fn split_at(self, _: usize) -> (Self, Self) {
        (Self, Self)
    }

    fn put(&mut self, _: usize, (): ()) {}
}

/// The cells of a list.
struct Cells<'a, R, const F: usize, const S: usize, P, O> {
    sorted: Sorted<'a>,
    columns: &'a Columns<F>,
    /// Particles and images near a cell, and those near a particle.
    candidates: &'a mut [Candidates<F>; 3],
    cells: Range<usize>,
    list: &'a mut List,
    outputs: O,
    pass: &'a P,
    factor: PhantomData<R>,
}

impl<R: Radial, const F: usize, const S: usize, P: ListedSum<F, S>, O: Outputs<P::Output>> Leaf
    for Cells<'_, R, F, S, P, O>
{
    #[inline(always)]
    fn run<V: Register>(self) {
        let Self { sorted, columns, candidates, cells, list, mut outputs, pass, .. } = self;
        let [particles_near, images_near, near] = candidates;
        let support = sorted.support_radius;
        let first = sorted.cell_start[cells.start] as usize;
        for cell in cells {
            let particles = sorted.run(cell, 1);
            if particles.is_empty() {
                continue;
            }
            let targets = sorted.positions[particles.clone()].iter().map(|p| p.truncate());
            let region = Region::around(targets, support);
            let runs = sorted.runs_around(cell);
            let reflections = sorted.images.near(region.low.into(), region.high.into(), support);
            particles_near.pack::<V>(columns, &runs, &region);
            let reflect = |by: &Reflection, values| pass.reflect(by, values);
            images_near.pack_only_images::<V>(columns, &runs, &region, reflections, reflect, mark);
            for i in particles {
                let x = splat::<V>(sorted.positions[i]);
                let [middle, end] = near.pack_near(x, support, [&*particles_near, &*images_near]);
                let all = near.columns_and_block();
                let position_and_place = [all[0], all[1], all[2], all[F - 1]];
                append_links::<R, V>(x, support, position_and_place, 0..middle, &mut list.neighbours);
                append_vectors::<R, V>(x, support, position_and_place, middle..end, &mut list.images);
                list.ends.push([list.neighbours.len(), list.images.len()]);
                let sums = if S == 0 { [0.0; S] } else { near.sum::<V, S>(pass.pair::<V>(i)) };
                outputs.put(i - first, pass.finish(i, sums));
            }
        }
    }
}

/// Replaces the places of particles by the bits of their images.
fn mark(by: &Reflection, places: &mut [f32]) {
    let axes = by.sign.cmplt(Vec3::ZERO).bitmask();
    for place in places {
        let index = place.to_bits() / 2;
        *place = f32::from_bits(NORMAL | index | axes << INDEX_BITS);
    }
}

/// Visits registers of particles near a point: with the bits of those that are not at the point, the factors, the differences
/// of the positions, and the fourth column. The columns must extend a block beyond the range.
#[inline(always)]
fn visit<R: Radial, V: Register>(
    x: [V; 3],
    support: f32,
    from: [&[f32]; 4],
    range: Range<usize>,
    mut found: impl FnMut(u32, V, [V; 3], V),
) {
    let inverse = 1.0 / support;
    for k in range.clone().step_by(V::WIDTH) {
        assert!(from.iter().all(|column| k + V::WIDTH <= column.len()));
        let mut values = [V::splat(0.0); 4];
        for (value, column) in values.iter_mut().zip(&from) {
            // SAFETY: the column is long enough, as just tested.
            *value = unsafe { V::load(column.as_ptr().add(k)) };
        }
        let [x_j, y_j, z_j, place] = values;
        let d = difference(x, [x_j, y_j, z_j]);
        let r2 = dot(d, d);
        let in_range = u32::MAX >> (32 - V::WIDTH.min(range.end - k));
        let others = V::splat(0.0).less_bits(r2) & in_range;
        found(others, R::factor(r2.sqrt() * inverse), d, place);
    }
}

/// The lanes whose bit is set, at the front of a block.
#[inline(always)]
fn compressed<V: Register, const N: usize>(values: [V; N], bits: u32) -> [[Vec4; BLOCK / 4]; N] {
    let mut columns = [[Vec4::ZERO; BLOCK / 4]; N];
    for (value, column) in values.into_iter().zip(&mut columns) {
        // SAFETY: a block is at least as wide as a register.
        unsafe { value.compress(bits).store(column.as_mut_ptr().cast()) };
    }
    columns
}

/// Appends the particles in a range of columns, without one at the point itself.
#[inline(always)]
fn append_links<R: Radial, V: Register>(
    x: [V; 3],
    support: f32,
    from: [&[f32]; 4],
    range: Range<usize>,
    links: &mut Vec<Link>,
) {
    links.reserve(range.len() + BLOCK);
    visit::<R, V>(x, support, from, range, |near, factor, _, index| {
        let (count, begin) = (near.count_ones() as usize, links.len());
        assert!(begin + BLOCK <= links.capacity());
        let [factors, indices] = compressed([factor, index], near);
        for quad in 0..count.div_ceil(4) {
            let (f, i) = (factors[quad], indices[quad]);
            let rows = [Vec4::new(f.x, i.x, f.y, i.y), Vec4::new(f.z, i.z, f.w, i.w)];
            // SAFETY: there is room for a block, as tested above. Four links have the size of the rows.
            unsafe { links.as_mut_ptr().add(begin + 4 * quad).cast::<[Vec4; 2]>().write_unaligned(rows) };
        }
        // SAFETY: this many have been written.
        unsafe { links.set_len(begin + count) };
    });
}

/// As [`append_links`], with the vectors.
#[inline(always)]
fn append_vectors<R: Radial, V: Register>(
    x: [V; 3],
    support: f32,
    from: [&[f32]; 4],
    range: Range<usize>,
    vectors: &mut Vec<Vec4>,
) {
    vectors.reserve(range.len() + BLOCK);
    visit::<R, V>(x, support, from, range, |near, factor, d, index| {
        let (count, begin) = (near.count_ones() as usize, vectors.len());
        assert!(begin + BLOCK <= vectors.capacity());
        let [sx, sy, sz] = scaled(factor, d);
        let [sx, sy, sz, index] = compressed([sx, sy, sz, index], near);
        for quad in 0..count.div_ceil(4) {
            let rows = Mat4::from_cols(sx[quad], sy[quad], sz[quad], index[quad]).transpose();
            // SAFETY: there is room for a block, as tested above.
            unsafe { vectors.as_mut_ptr().add(begin + 4 * quad).cast::<Mat4>().write(rows) };
        }
        // SAFETY: this many have been written.
        unsafe { vectors.set_len(begin + count) };
    });
}
