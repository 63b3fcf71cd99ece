//! Sums over the neighbours in a list.

use bytemuck::{Pod, Zeroable};
use glam::Vec4;

use super::lists::INDEX_BITS;
use super::vectors::{self, Formula, Vectors};
use crate::simd::Simd;

/// The signs of the components of an image by the code of its reflection: which axes are reflected.
const SIGNS: [Vec4; 8] = {
    let [p, n] = [1.0, -1.0];
    [
        Vec4::new(p, p, p, p),
        Vec4::new(n, p, p, p),
        Vec4::new(p, n, p, p),
        Vec4::new(n, n, p, p),
        Vec4::new(p, p, n, p),
        Vec4::new(n, p, n, p),
        Vec4::new(p, n, n, p),
        Vec4::new(n, n, n, p),
    ]
};

/// A neighbour: its place among vectors, and the factor on the difference of the positions.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Link {
    pub(super) factor: f32,
    /// Twice the index: addresses in instructions scale by at most eight bytes, and a vector has 16.
    pub(super) place: u32,
}

impl Link {
    #[inline(always)]
    pub(super) fn index(&self) -> usize {
        (self.place / 2) as usize
    }

    /// The place of particle `index`, as it is stored between numbers.
    pub fn place_bits(index: usize) -> f32 {
        f32::from_bits(2 * index as u32)
    }
}

/// The neighbours of particle `i`. The sums contain s = factor (x_i - x_j) for each neighbour j.
#[derive(Clone, Copy)]
pub(crate) struct Near<'a> {
    i: usize,
    links: &'a [Link],
    /// All indices are below this number.
    bound: usize,
    /// The processor has these registers.
    simd: Simd,
}

impl<'a> Near<'a> {
    /// # Safety
    /// The indices of the links must be below `bound`, and the processor must have these registers.
    pub(super) unsafe fn new(i: usize, links: &'a [Link], bound: usize, simd: Simd) -> Self {
        Self { i, links, bound, simd }
    }

    /// The sum of (v_i + v_j) s. A point is a position and the value v; the fourth component of the result has no meaning.
    #[inline]
    pub fn sum_of_values(self, points: &[Vec4]) -> Vec4 {
        assert!(self.bound <= points.len());
        let own = points[self.i] * Vec4::new(1.0, 1.0, 1.0, -1.0);
        -self.sum(&Values { own, points })
    }

    /// The sum of the products, component by component, of s and u_i - u_j.
    #[inline]
    pub fn sum_of_differences(self, positions: &[Vec4], vectors: &[Vec4]) -> Vec4 {
        self.sum(&self.differences(positions, vectors))
    }

    /// The sum of the projections s (s.(u_i - u_j)). The fourth components of the vectors must be zero.
    #[inline]
    pub fn sum_of_projections(self, positions: &[Vec4], vectors: &[Vec4]) -> Vec4 {
        self.sum(&Projections(self.differences(positions, vectors)))
    }

    #[inline]
    fn differences<'b>(self, positions: &'b [Vec4], vectors: &'b [Vec4]) -> Differences<'b> {
        assert!(self.bound <= positions.len() && self.bound <= vectors.len());
        Differences { own: [positions[self.i], vectors[self.i]], positions, vectors }
    }

    #[inline]
    fn sum(self, formula: &impl Formula) -> Vec4 {
        // SAFETY: the processor has these registers, as the caller of `new` guarantees.
        unsafe { vectors::sum(self.simd, self.links, formula) }
    }

    /// The indices of the neighbours.
    #[cfg(test)]
    pub fn indices(self) -> impl Iterator<Item = usize> {
        self.links.iter().map(Link::index)
    }
}

/// (v_i + v_j) s, from points with the value as the fourth component, which is negated in the own one: the difference of two
/// points then contains the sum of their values.
struct Values<'a> {
    own: Vec4,
    points: &'a [Vec4],
}

impl Formula for Values<'_> {
    #[inline(always)]
    fn of<Q: Vectors>(&self, links: Q::Links<'_>) -> Q {
        // SAFETY: all indices are below the number of points: see `Near::sum_of_values`.
        let d = Q::splat(self.own) - unsafe { Q::gather(links, self.points) };
        d * (Q::factors(links) * d.last())
    }
}

/// The products, component by component, of s and u_i - u_j.
struct Differences<'a> {
    own: [Vec4; 2],
    positions: &'a [Vec4],
    vectors: &'a [Vec4],
}

impl Differences<'_> {
    /// s, and u_i - u_j.
    #[inline(always)]
    fn parts<Q: Vectors>(&self, links: Q::Links<'_>) -> [Q; 2] {
        let [x, u] = self.own.map(Q::splat);
        // SAFETY: all indices are below the numbers of positions and of vectors: see `Near::differences`.
        let [x_j, u_j] = unsafe { [Q::gather(links, self.positions), Q::gather(links, self.vectors)] };
        [Q::factors(links) * (x - x_j), u - u_j]
    }
}

impl Formula for Differences<'_> {
    #[inline(always)]
    fn of<Q: Vectors>(&self, links: Q::Links<'_>) -> Q {
        let [s, u] = self.parts::<Q>(links);
        s * u
    }
}

/// The projections s (s.(u_i - u_j)).
struct Projections<'a>(Differences<'a>);

impl Formula for Projections<'_> {
    #[inline(always)]
    fn of<Q: Vectors>(&self, links: Q::Links<'_>) -> Q {
        let [s, u] = self.0.parts::<Q>(links);
        s * (s * u).totals()
    }
}

/// The images of particles that are neighbours: for each the vector s, and the bits of its index and its reflection.
#[derive(Clone, Copy)]
pub(crate) struct NearImages<'a>(&'a [Vec4]);

impl<'a> NearImages<'a> {
    pub(super) fn new(images: &'a [Vec4]) -> Self {
        Self(images)
    }

    /// The vector s, whose fourth component has no meaning, the signs of a reflected vector, and the index.
    #[inline(always)]
    pub fn iter(self) -> impl Iterator<Item = (Vec4, Vec4, usize)> {
        self.0.iter().map(|image| {
            let bits = image.w.to_bits();
            let index = bits & ((1 << INDEX_BITS) - 1);
            (*image, SIGNS[(bits >> INDEX_BITS & 7) as usize], index as usize)
        })
    }
}
