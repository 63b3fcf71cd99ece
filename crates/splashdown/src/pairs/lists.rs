//! Lists of the neighbours of every particle with a factor for each, such as that of the gradient of the kernel, for passes
//! that visit the same neighbours many times in a step.
//!
//! A visit of the candidates tests four times as many particles as there are neighbours, and computes a square root for
//! each. A list is made in one such visit, which also computes sums; a visit of a list costs less than half as much. A
//! neighbour takes 8 bytes: the factor and its index. Reading the list is what a visit waits for, so that subtracting the
//! positions again costs less than reading their difference. Images behind walls are few and take 16 bytes: the vector, and
//! bits for index and reflection.

use std::marker::PhantomData;
use std::ops::Range;

use glam::{Mat4, UVec3, Vec3, Vec4};
use rayon::prelude::*;

use super::Sorted;
use super::candidates::{Candidates, Region, Sums};
use super::columns::Columns;
use super::near::{Link, Near, NearImages};
use super::particles::{Outputs, pieces};
use super::vector::{difference, dot, reflected_point, scaled, splat};
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

/// What lists depend on besides the positions: support radius, images, and the origin, the size and the slices of the grid.
type Conditions = (f32, Images, Vec3, UVec3, u32);

fn conditions(sorted: Sorted<'_>) -> Conditions {
    let Sorted { grid, support_radius, images, .. } = sorted;
    (support_radius, images, grid.origin, grid.size(), grid.slices)
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
            let pass = NoSum::<R> { positions, scale: 1.0 / sorted.support_radius, factor: PhantomData };
            self.make_with(simd, sorted, Nothing, &pass);
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
            || [Candidates::new(), Candidates::new()],
            |candidates, (list, (cells, outputs))| {
                list.ends.clear();
                list.neighbours.clear();
                list.images.clear();
                run_with(simd, Cells { sorted, columns, candidates, cells, list, outputs, pass });
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

/// A pass that runs while lists are made. As [`PairSum`](super::PairSum), but the last column must be the
/// [place](Link::place_bits) of the particle, and pairs contain the factor of the list.
pub(crate) trait ListedSum<const F: usize, const S: usize>: Sync {
    /// The result of a particle.
    type Output: Send;

    /// The values of particle `j` in the columns.
    fn load(&self, j: usize) -> [f32; F];

    /// A register of neighbours of particle `i`.
    fn pair<V: Register>(&self, i: usize) -> impl Fn([V; F]) -> ListedPair<V, S>;

    /// The columns of the images of a register of neighbours behind a wall.
    fn reflect<V: Register>(&self, reflection: &Reflection, values: [V; F]) -> [V; F];

    /// The result of particle `i` for its sums.
    fn finish(&self, i: usize, sums: [f32; S]) -> Self::Output;
}

/// What a list and a pass need of a register of pairs.
pub(crate) struct ListedPair<V, const S: usize> {
    /// The difference of the positions, x_i - x_j.
    pub d: [V; 3],
    /// Its square.
    pub r2: V,
    /// The factor in the list.
    pub factor: V,
    /// The contributions to the sums; zero beyond the support radius.
    pub sums: [V; S],
}

/// No sums.
struct NoSum<'a, R> {
    positions: &'a [Vec4],
    scale: f32,
    factor: PhantomData<R>,
}

impl<R: Radial> ListedSum<4, 0> for NoSum<'_, R> {
    type Output = ();

    #[inline(always)]
    fn load(&self, j: usize) -> [f32; 4] {
        let [x, y, z, _] = self.positions[j].to_array();
        [x, y, z, Link::place_bits(j)]
    }

    #[inline(always)]
    fn pair<V: Register>(&self, i: usize) -> impl Fn([V; 4]) -> ListedPair<V, 0> {
        let x = splat::<V>(self.positions[i]);
        #[inline(always)]
        move |[x_j, y_j, z_j, _]| {
            let d = difference(x, [x_j, y_j, z_j]);
            let r2 = dot(d, d);
            ListedPair { d, r2, factor: R::factor(r2.sqrt() * self.scale), sums: [] }
        }
    }

    #[inline(always)]
    fn reflect<V: Register>(&self, by: &Reflection, [x, y, z, place]: [V; 4]) -> [V; 4] {
        let [x, y, z] = reflected_point(by, [x, y, z]);
        [x, y, z, place]
    }

    #[inline(always)]
    fn finish(&self, _: usize, _: [f32; 0]) {}
}

/// No results.
struct Nothing;

impl Outputs<()> for Nothing {
    fn split_at(self, _: usize) -> (Self, Self) {
        (Self, Self)
    }

    fn put(&mut self, _: usize, (): ()) {}
}

/// The cells of a list.
struct Cells<'a, const F: usize, const S: usize, P, O> {
    sorted: Sorted<'a>,
    columns: &'a Columns<F>,
    /// Particles and images near a cube.
    candidates: &'a mut [Candidates<F>; 2],
    cells: Range<usize>,
    list: &'a mut List,
    outputs: O,
    pass: &'a P,
}

impl<const F: usize, const S: usize, P: ListedSum<F, S>, O: Outputs<P::Output>> Leaf
    for Cells<'_, F, S, P, O>
{
    #[inline(always)]
    fn run<V: Register>(self) {
        let Self { sorted, columns, candidates, cells, list, mut outputs, pass } = self;
        let [particles_near, images_near] = candidates;
        let support = sorted.support_radius;
        let reach2 = V::splat(support * support);
        let first = sorted.cell_start[cells.start] as usize;
        for cube in cells.step_by(sorted.grid.slices as usize) {
            let particles = sorted.cube(cube);
            if particles.is_empty() {
                continue;
            }
            let targets = sorted.positions[particles.clone()].iter().map(|p| p.truncate());
            let region = Region::around(targets, support);
            let runs = sorted.runs_around(cube);
            let reflections = sorted.images.near(region.low.into(), region.high.into(), support);
            particles_near.pack::<V>(columns, &runs, &region);
            let reflect = |by: &Reflection, values| pass.reflect(by, values);
            images_near.pack_only_images::<V>(columns, &runs, &region, reflections, reflect, mark);
            for i in particles {
                let pair = pass.pair::<V>(i);
                let mut sums = Sums::<V, S>::new();
                list.neighbours.reserve(particles_near.len() + BLOCK);
                particles_near.visit::<V>(|part, values| {
                    let pair = pair(values);
                    sums.add(part, pair.sums);
                    append_link(near(pair.r2, reach2), pair.factor, values[F - 1], &mut list.neighbours);
                });
                list.images.reserve(images_near.len() + BLOCK);
                images_near.visit::<V>(|part, values| {
                    let pair = pair(values);
                    sums.add(part, pair.sums);
                    let vector = scaled(pair.factor, pair.d);
                    append_vector(near(pair.r2, reach2), vector, values[F - 1], &mut list.images);
                });
                list.ends.push([list.neighbours.len(), list.images.len()]);
                outputs.put(i - first, pass.finish(i, sums.totals()));
            }
        }
    }
}

/// The bits of the other particles within the support radius.
#[inline(always)]
fn near<V: Register>(r2: V, reach2: V) -> u32 {
    r2.less_bits(reach2) & V::splat(0.0).less_bits(r2)
}

/// Replaces the places of particles by the bits of their images.
fn mark(by: &Reflection, places: &mut [f32]) {
    let axes = by.sign.cmplt(Vec3::ZERO).bitmask();
    for place in places {
        let index = place.to_bits() / 2;
        *place = f32::from_bits(NORMAL | index | axes << INDEX_BITS);
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

/// Appends the particles whose bit is set. There must be room for a block.
#[inline(always)]
fn append_link<V: Register>(near: u32, factor: V, place: V, links: &mut Vec<Link>) {
    if near == 0 {
        return;
    }
    let (count, begin) = (near.count_ones() as usize, links.len());
    assert!(begin + BLOCK <= links.capacity());
    let [factors, places] = compressed([factor, place], near);
    for quad in 0..count.div_ceil(4) {
        let (f, p) = (factors[quad], places[quad]);
        let rows = [Vec4::new(f.x, p.x, f.y, p.y), Vec4::new(f.z, p.z, f.w, p.w)];
        // SAFETY: there is room for a block, as tested above. Four links have the size of the rows.
        unsafe { links.as_mut_ptr().add(begin + 4 * quad).cast::<[Vec4; 2]>().write_unaligned(rows) };
    }
    // SAFETY: this many have been written.
    unsafe { links.set_len(begin + count) };
}

/// As [`append_link`], with vectors instead of factors.
#[inline(always)]
fn append_vector<V: Register>(near: u32, [x, y, z]: [V; 3], image: V, vectors: &mut Vec<Vec4>) {
    if near == 0 {
        return;
    }
    let (count, begin) = (near.count_ones() as usize, vectors.len());
    assert!(begin + BLOCK <= vectors.capacity());
    let [x, y, z, image] = compressed([x, y, z, image], near);
    for quad in 0..count.div_ceil(4) {
        let rows = Mat4::from_cols(x[quad], y[quad], z[quad], image[quad]).transpose();
        // SAFETY: there is room for a block, as tested above.
        unsafe { vectors.as_mut_ptr().add(begin + 4 * quad).cast::<Mat4>().write(rows) };
    }
    // SAFETY: this many have been written.
    unsafe { vectors.set_len(begin + count) };
}
