//! Sums over the neighbours in a list.

use bytemuck::{Pod, Zeroable};
use glam::Vec4;

use super::lists::INDEX_BITS;
use super::vectors::Quad;

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

    /// A link to particle `index` that contributes nothing.
    #[inline(always)]
    pub(super) fn none(index: usize) -> Self {
        Self { factor: 0.0, place: 2 * index as u32 }
    }

    /// The place of particle `index`, as it is stored between numbers.
    pub fn place_bits(index: usize) -> f32 {
        f32::from_bits(2 * index as u32)
    }
}

/// What is added up over the neighbours j of a particle i. The sums contain s = factor (x_i - x_j).
pub(crate) trait Formula: Sync {
    /// The number of vectors: indices must be below it.
    fn count(&self) -> usize;

    /// The vectors of four particles, from particle `i` on.
    fn own<Q: Quad>(&self, i: usize) -> [Q; 2];

    /// The contribution of a neighbour to the sum of each particle.
    ///
    /// # Safety
    /// The indices of the links must be below [`count`](Self::count).
    unsafe fn of<Q: Quad>(&self, own: [Q; 2], links: &[Link; 4]) -> Q;
}

/// Four values, from value `i` on; the last one again where there are fewer.
#[inline(always)]
fn four<T: Copy>(values: &[T], i: usize) -> [T; 4] {
    match values[i..].first_chunk() {
        Some(chunk) => *chunk,
        None => std::array::from_fn(|k| values[(i + k).min(values.len() - 1)]),
    }
}

/// The sum of -(v_i + v_j) s, from points: positions with the value v as the fourth component. That of the result has no
/// meaning.
///
/// The own value is negated, so that the difference of two points contains the sum of their values.
pub(crate) struct Values<'a>(pub &'a [Vec4]);

impl Formula for Values<'_> {
    #[inline(always)]
    fn count(&self) -> usize {
        self.0.len()
    }

    #[inline(always)]
    fn own<Q: Quad>(&self, i: usize) -> [Q; 2] {
        let own = Q::load(&four(self.0, i)) * Q::splat(Vec4::new(1.0, 1.0, 1.0, -1.0));
        [own, own]
    }

    #[inline(always)]
    unsafe fn of<Q: Quad>(&self, [own, _]: [Q; 2], links: &[Link; 4]) -> Q {
        // SAFETY: as for this function.
        let d = own - unsafe { Q::gather(links, self.0) };
        d * (Q::factors(links) * d.last())
    }
}

/// The sum of the products, component by component, of s and u_i - u_j, from pairs of a position and the vector u.
pub(crate) struct Differences<'a>(pub &'a [[Vec4; 2]]);

impl Differences<'_> {
    /// s, and u_i - u_j.
    ///
    /// # Safety
    /// As for [`Formula::of`].
    #[inline(always)]
    unsafe fn parts<Q: Quad>(&self, [x, u]: [Q; 2], links: &[Link; 4]) -> [Q; 2] {
        // SAFETY: as for this function.
        let [x_j, u_j] = unsafe { Q::gather_pairs(links, self.0) };
        [Q::factors(links) * (x - x_j), u - u_j]
    }
}

impl Formula for Differences<'_> {
    #[inline(always)]
    fn count(&self) -> usize {
        self.0.len()
    }

    #[inline(always)]
    fn own<Q: Quad>(&self, i: usize) -> [Q; 2] {
        Q::load_pairs(&four(self.0, i))
    }

    #[inline(always)]
    unsafe fn of<Q: Quad>(&self, own: [Q; 2], links: &[Link; 4]) -> Q {
        // SAFETY: as for this function.
        let [s, u] = unsafe { self.parts(own, links) };
        s * u
    }
}

/// The sum of the projections s (s.(u_i - u_j)). The fourth components of the vectors must be zero.
pub(crate) struct Projections<'a>(pub Differences<'a>);

impl Formula for Projections<'_> {
    #[inline(always)]
    fn count(&self) -> usize {
        self.0.count()
    }

    #[inline(always)]
    fn own<Q: Quad>(&self, i: usize) -> [Q; 2] {
        self.0.own(i)
    }

    #[inline(always)]
    unsafe fn of<Q: Quad>(&self, own: [Q; 2], links: &[Link; 4]) -> Q {
        // SAFETY: as for this function.
        let [s, u] = unsafe { self.0.parts(own, links) };
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
