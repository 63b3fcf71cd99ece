//! Lists are made in one visit of the candidates, which also computes sums.

use std::marker::PhantomData;
use std::ops::Range;

use glam::{Mat4, Vec3, Vec4};

use super::list::List;
use super::{INDEX_BITS, Radial};
use crate::boundary::Reflection;
use crate::pairs::Sorted;
use crate::pairs::candidates::{Candidates, Region, Sums};
use crate::pairs::columns::Columns;
use crate::pairs::near::Link;
use crate::pairs::particles::Outputs;
use crate::pairs::vector::{difference, dot, reflected_point, scaled, splat};
use crate::simd::{BLOCK, Leaf, Register};

/// A bit that makes the index of an image, which is stored with three numbers, a normal number: arithmetic with subnormal
/// ones can take a hundred times as long.
const NORMAL: u32 = 1 << 30;

/// A pass that runs while lists are made. As [`PairSum`](crate::pairs::PairSum), but the last column must be the
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
pub(super) struct NoSum<'a, R> {
    positions: &'a [Vec4],
    scale: f32,
    factor: PhantomData<R>,
}

impl<'a, R> NoSum<'a, R> {
    pub fn new(positions: &'a [Vec4], support_radius: f32) -> Self {
        Self { positions, scale: 1.0 / support_radius, factor: PhantomData }
    }
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
pub(super) struct Nothing;

impl Outputs<()> for Nothing {
    fn split_at(self, _: usize) -> (Self, Self) {
        (Self, Self)
    }

    fn put(&mut self, _: usize, (): ()) {}
}

/// Makes the list of some rows of cells.
pub(super) struct Cells<'a, const F: usize, const S: usize, P, O> {
    pub sorted: Sorted<'a>,
    pub columns: &'a Columns<F>,
    /// Memory for the particles and the images near a cube, and for the particles near a particle.
    pub candidates: &'a mut [Candidates<F>; 3],
    pub cells: Range<usize>,
    pub list: &'a mut List,
    pub outputs: O,
    pub pass: &'a P,
}

impl<const F: usize, const S: usize, P: ListedSum<F, S>, O: Outputs<P::Output>> Leaf
    for Cells<'_, F, S, P, O>
{
    #[inline(always)]
    fn run<V: Register>(self) {
        let Self { sorted, columns, candidates, cells, list, mut outputs, pass } = self;
        let [particles, images, near] = candidates;
        let support = sorted.support_radius;
        let reach2 = V::splat(support * support);
        let first = sorted.cell_start[cells.start] as usize;
        for cube in cells.step_by(sorted.grid.slices as usize) {
            let targets = sorted.cube(cube);
            if targets.is_empty() {
                continue;
            }
            let points = sorted.positions[targets.clone()].iter().map(|p| p.truncate());
            let region = Region::around(points, support);
            let runs = sorted.runs_around(cube);
            let reflections = sorted.images.near(region.low.into(), region.high.into(), support);
            particles.pack::<V>(columns, &runs, &region);
            let reflect = |by: &Reflection, values| pass.reflect(by, values);
            images.pack_only_images::<V>(columns, &runs, &region, reflections, reflect, mark);
            for i in targets {
                let pair = pass.pair::<V>(i);
                let mut sums = Sums::<V, S>::new();
                near.pack_near(particles, splat::<V>(sorted.positions[i]), reach2);
                let links = list.neighbours();
                links.reserve(near.len() + BLOCK);
                near.visit::<V>(|part, values| {
                    let pair = pair(values);
                    sums.add(part, pair.sums);
                    append_link(others(pair.r2, reach2), pair.factor, values[F - 1], links);
                });
                let vectors = list.images();
                vectors.reserve(images.len() + BLOCK);
                images.visit::<V>(|part, values| {
                    let pair = pair(values);
                    sums.add(part, pair.sums);
                    let vector = scaled(pair.factor, pair.d);
                    append_vector(others(pair.r2, reach2), vector, values[F - 1], vectors);
                });
                list.end_particle(first);
                outputs.put(i - first, pass.finish(i, sums.totals()));
            }
        }
        list.end(first);
    }
}

/// The bits of the other particles within the support radius.
#[inline(always)]
fn others<V: Register>(r2: V, reach2: V) -> u32 {
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
    // All of them, because a branch would often be mispredicted.
    for (quad, (f, p)) in factors.into_iter().zip(places).enumerate() {
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
