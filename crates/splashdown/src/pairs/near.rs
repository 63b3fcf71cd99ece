//! Sums over the neighbours in a list.

use bytemuck::{Pod, Zeroable};
use glam::{Vec4, Vec4Swizzles};

use super::lists::INDEX_BITS;
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
    fn index(&self) -> usize {
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
    #[cfg_attr(not(target_arch = "x86_64"), expect(dead_code, reason = "other processors have one kind"))]
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
        // The difference of two points then contains the sum of their values.
        let own = points[self.i] * Vec4::new(1.0, 1.0, 1.0, -1.0);
        assert!(self.bound <= points.len());
        #[cfg(target_arch = "x86_64")]
        if self.simd >= Simd::Avx512 {
            // SAFETY: the processor has AVX-512, and the indices are below the lengths, as just tested.
            return -unsafe { avx512::sum_of_values(self.links, own, points) };
        } else if self.simd >= Simd::Avx2 {
            // SAFETY: as above, with AVX2.
            return -unsafe { avx2::sum_of_values(self.links, own, points) };
        }
        -self.sum(|factor, j| {
            let d = own - points[j];
            d * (factor * d.wwww())
        })
    }

    /// The sum of the products, component by component, of s and u_i - u_j.
    #[inline]
    pub fn sum_of_differences(self, positions: &[Vec4], vectors: &[Vec4]) -> Vec4 {
        let (x, u) = (positions[self.i], vectors[self.i]);
        assert!(self.bound <= positions.len() && self.bound <= vectors.len());
        #[cfg(target_arch = "x86_64")]
        if self.simd >= Simd::Avx512 {
            // SAFETY: the processor has AVX-512, and the indices are below the lengths, as just tested.
            return unsafe { avx512::sum_of_differences(self.links, [x, u], [positions, vectors]) };
        } else if self.simd >= Simd::Avx2 {
            // SAFETY: as above, with AVX2.
            return unsafe { avx2::sum_of_differences(self.links, [x, u], [positions, vectors]) };
        }
        self.sum(|factor, j| (factor * (x - positions[j])) * (u - vectors[j]))
    }

    /// The sum of the projections s (s.(u_i - u_j)). The fourth components of the vectors must be zero.
    #[inline]
    pub fn sum_of_projections(self, positions: &[Vec4], vectors: &[Vec4]) -> Vec4 {
        let (x, u) = (positions[self.i], vectors[self.i]);
        assert!(self.bound <= positions.len() && self.bound <= vectors.len());
        #[cfg(target_arch = "x86_64")]
        if self.simd >= Simd::Avx512 {
            // SAFETY: the processor has AVX-512, and the indices are below the lengths, as just tested.
            return unsafe { avx512::sum_of_projections(self.links, [x, u], [positions, vectors]) };
        } else if self.simd >= Simd::Avx2 {
            // SAFETY: as above, with AVX2.
            return unsafe { avx2::sum_of_projections(self.links, [x, u], [positions, vectors]) };
        }
        self.sum(|factor, j| projected(factor * (x - positions[j]), u - vectors[j]))
    }

    /// The indices of the neighbours.
    #[cfg(test)]
    pub fn indices(self) -> impl Iterator<Item = usize> {
        self.links.iter().map(Link::index)
    }

    /// The sum of a contribution of each neighbour, from its factor and its index. Four partial sums, because an addition
    /// takes four cycles.
    #[inline(always)]
    fn sum(self, contribution: impl Fn(f32, usize) -> Vec4) -> Vec4 {
        let mut sums = [Vec4::ZERO; 4];
        let (quads, rest) = self.links.as_chunks::<4>();
        for quad in quads {
            for (sum, link) in sums.iter_mut().zip(quad) {
                *sum += contribution(link.factor, link.index());
            }
        }
        for (sum, link) in sums.iter_mut().zip(rest) {
            *sum += contribution(link.factor, link.index());
        }
        (sums[0] + sums[1]) + (sums[2] + sums[3])
    }
}

/// s (s.v), with the additions in a fixed order.
#[inline(always)]
fn projected(s: Vec4, v: Vec4) -> Vec4 {
    let p = s * v;
    // (x + y, y + x, z + w, w + z), and then all four.
    let pairs = p + p.yxwz();
    s * (pairs + pairs.zwxy())
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

/// The vector of a link.
///
/// # Safety
/// The index of the link must be below the number of vectors.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
unsafe fn place(vectors: &[Vec4], link: &Link) -> *const f32 {
    // SAFETY: a reference is valid. The read is volatile because the compiler would otherwise take the place out of a register
    // into which it has loaded the factors of several links, which takes twice as many instructions.
    let place = unsafe { std::ptr::read_volatile(&link.place) } as usize;
    // SAFETY: the place is twice the index, in units of half a vector.
    unsafe { vectors.as_ptr().cast::<[f32; 2]>().add(place).cast() }
}

/// Two neighbours per register, with the same results to the bit.
#[cfg(target_arch = "x86_64")]
mod avx2 {
    use std::arch::x86_64::{
        __m256, _mm_load_ps, _mm256_add_ps, _mm256_blend_ps, _mm256_broadcast_ss, _mm256_castps256_ps128,
        _mm256_extractf128_ps, _mm256_mul_ps, _mm256_permute_ps, _mm256_setr_m128, _mm256_setzero_ps,
        _mm256_sub_ps,
    };

    use glam::{Vec4, Vec4Swizzles};

    use super::{Link, place, projected};

    /// # Safety
    /// The indices of the links must be below the number of points.
    #[target_feature(enable = "avx2")]
    pub(super) unsafe fn sum_of_values(links: &[Link], own: Vec4, points: &[Vec4]) -> Vec4 {
        let own_2 = twice(own);
        let pair = |links: &[Link; 2]| {
            // SAFETY: as for this function.
            let d = _mm256_sub_ps(own_2, unsafe { vectors(links, points) });
            _mm256_mul_ps(d, _mm256_mul_ps(factors(links), _mm256_permute_ps::<0b11_11_11_11>(d)))
        };
        let single = |factor: f32, j: usize| {
            let d = own - points[j];
            d * (factor * d.wwww())
        };
        sum(links, pair, single)
    }

    /// # Safety
    /// The indices of the links must be below the numbers of positions and of vectors.
    #[target_feature(enable = "avx2")]
    pub(super) unsafe fn sum_of_differences(
        links: &[Link],
        [x, u]: [Vec4; 2],
        [xs, us]: [&[Vec4]; 2],
    ) -> Vec4 {
        let (x_2, u_2) = (twice(x), twice(u));
        let pair = |links: &[Link; 2]| {
            // SAFETY: as for this function.
            let (x, u) = unsafe { (vectors(links, xs), vectors(links, us)) };
            _mm256_mul_ps(_mm256_mul_ps(factors(links), _mm256_sub_ps(x_2, x)), _mm256_sub_ps(u_2, u))
        };
        sum(links, pair, |factor, j| (factor * (x - xs[j])) * (u - us[j]))
    }

    /// # Safety
    /// The indices of the links must be below the numbers of positions and of vectors.
    #[target_feature(enable = "avx2")]
    pub(super) unsafe fn sum_of_projections(
        links: &[Link],
        [x, u]: [Vec4; 2],
        [xs, us]: [&[Vec4]; 2],
    ) -> Vec4 {
        let (x_2, u_2) = (twice(x), twice(u));
        let pair = |links: &[Link; 2]| {
            // SAFETY: as for this function.
            let (x, u) = unsafe { (vectors(links, xs), vectors(links, us)) };
            let s = _mm256_mul_ps(factors(links), _mm256_sub_ps(x_2, x));
            let p = _mm256_mul_ps(s, _mm256_sub_ps(u_2, u));
            let pairs = _mm256_add_ps(p, _mm256_permute_ps::<0b10_11_00_01>(p));
            _mm256_mul_ps(s, _mm256_add_ps(pairs, _mm256_permute_ps::<0b01_00_11_10>(pairs)))
        };
        sum(links, pair, |factor, j| projected(factor * (x - xs[j]), u - us[j]))
    }

    #[inline]
    #[target_feature(enable = "avx2")]
    fn twice(v: Vec4) -> __m256 {
        _mm256_setr_m128(v.into(), v.into())
    }

    #[inline]
    #[target_feature(enable = "avx2")]
    fn factors([a, b]: &[Link; 2]) -> __m256 {
        _mm256_blend_ps::<0xf0>(_mm256_broadcast_ss(&a.factor), _mm256_broadcast_ss(&b.factor))
    }

    /// # Safety
    /// The indices of the links must be below the number of vectors.
    #[inline]
    #[target_feature(enable = "avx2")]
    unsafe fn vectors(links: &[Link; 2], vectors: &[Vec4]) -> __m256 {
        // SAFETY: as for this function.
        let [a, b] = links.each_ref().map(|link| unsafe { _mm_load_ps(place(vectors, link)) });
        _mm256_setr_m128(a, b)
    }

    /// As [`Near::sum`](super::Near::sum), from the contributions of two neighbours and of one.
    #[inline]
    #[target_feature(enable = "avx2")]
    fn sum(links: &[Link], pair: impl Fn(&[Link; 2]) -> __m256, single: impl Fn(f32, usize) -> Vec4) -> Vec4 {
        let mut sums = [_mm256_setzero_ps(); 2];
        let (quads, rest) = links.as_chunks::<4>();
        for quad in quads {
            for (sum, both) in sums.iter_mut().zip(quad.as_chunks::<2>().0) {
                *sum = _mm256_add_ps(*sum, pair(both));
            }
        }
        let [a, b] = sums.map(|sum| {
            [Vec4::from(_mm256_castps256_ps128(sum)), Vec4::from(_mm256_extractf128_ps::<1>(sum))]
        });
        let mut sums = [a[0], a[1], b[0], b[1]];
        for (sum, link) in sums.iter_mut().zip(rest) {
            *sum += single(link.factor, link.index());
        }
        (sums[0] + sums[1]) + (sums[2] + sums[3])
    }
}

/// Four neighbours per register, with the same results to the bit.
#[cfg(target_arch = "x86_64")]
mod avx512 {
    use std::arch::x86_64::{
        __m512, _mm_load_ps, _mm256_loadu_ps, _mm512_add_ps, _mm512_broadcast_f32x4, _mm512_castps128_ps512,
        _mm512_castps256_ps512, _mm512_extractf32x4_ps, _mm512_insertf32x4, _mm512_mul_ps, _mm512_permute_ps,
        _mm512_permutexvar_ps, _mm512_setr_epi32, _mm512_setzero_ps, _mm512_sub_ps,
    };

    use glam::{Vec4, Vec4Swizzles};

    use super::{Link, place, projected};

    /// # Safety
    /// The indices of the links must be below the number of points.
    #[target_feature(enable = "avx512f")]
    pub(super) unsafe fn sum_of_values(links: &[Link], own: Vec4, points: &[Vec4]) -> Vec4 {
        let own_4 = _mm512_broadcast_f32x4(own.into());
        let quad = |links: &[Link; 4]| {
            // SAFETY: as for this function.
            let d = _mm512_sub_ps(own_4, unsafe { vectors(links, points) });
            _mm512_mul_ps(d, _mm512_mul_ps(factors(links), _mm512_permute_ps::<0b11_11_11_11>(d)))
        };
        let single = |factor: f32, j: usize| {
            let d = own - points[j];
            d * (factor * d.wwww())
        };
        sum(links, quad, single)
    }

    /// # Safety
    /// The indices of the links must be below the numbers of positions and of vectors.
    #[target_feature(enable = "avx512f")]
    pub(super) unsafe fn sum_of_differences(
        links: &[Link],
        [x, u]: [Vec4; 2],
        [xs, us]: [&[Vec4]; 2],
    ) -> Vec4 {
        let [x_4, u_4] = [_mm512_broadcast_f32x4(x.into()), _mm512_broadcast_f32x4(u.into())];
        let quad = |links: &[Link; 4]| {
            // SAFETY: as for this function.
            let (x, u) = unsafe { (vectors(links, xs), vectors(links, us)) };
            _mm512_mul_ps(_mm512_mul_ps(factors(links), _mm512_sub_ps(x_4, x)), _mm512_sub_ps(u_4, u))
        };
        sum(links, quad, |factor, j| (factor * (x - xs[j])) * (u - us[j]))
    }

    /// # Safety
    /// The indices of the links must be below the numbers of positions and of vectors.
    #[target_feature(enable = "avx512f")]
    pub(super) unsafe fn sum_of_projections(
        links: &[Link],
        [x, u]: [Vec4; 2],
        [xs, us]: [&[Vec4]; 2],
    ) -> Vec4 {
        let [x_4, u_4] = [_mm512_broadcast_f32x4(x.into()), _mm512_broadcast_f32x4(u.into())];
        let quad = |links: &[Link; 4]| {
            // SAFETY: as for this function.
            let (x, u) = unsafe { (vectors(links, xs), vectors(links, us)) };
            let s = _mm512_mul_ps(factors(links), _mm512_sub_ps(x_4, x));
            let p = _mm512_mul_ps(s, _mm512_sub_ps(u_4, u));
            let pairs = _mm512_add_ps(p, _mm512_permute_ps::<0b10_11_00_01>(p));
            _mm512_mul_ps(s, _mm512_add_ps(pairs, _mm512_permute_ps::<0b01_00_11_10>(pairs)))
        };
        sum(links, quad, |factor, j| projected(factor * (x - xs[j]), u - us[j]))
    }

    #[inline]
    #[target_feature(enable = "avx512f")]
    fn factors(links: &[Link; 4]) -> __m512 {
        let of_all = _mm512_setr_epi32(0, 0, 0, 0, 2, 2, 2, 2, 4, 4, 4, 4, 6, 6, 6, 6);
        // SAFETY: four links have the size of eight numbers.
        let links = unsafe { _mm256_loadu_ps(links.as_ptr().cast::<f32>()) };
        _mm512_permutexvar_ps(of_all, _mm512_castps256_ps512(links))
    }

    /// # Safety
    /// The indices of the links must be below the number of vectors.
    #[inline]
    #[target_feature(enable = "avx512f")]
    unsafe fn vectors(links: &[Link; 4], vectors: &[Vec4]) -> __m512 {
        // SAFETY: as for this function.
        let [a, b, c, d] = links.each_ref().map(|link| unsafe { _mm_load_ps(place(vectors, link)) });
        let ab = _mm512_insertf32x4::<1>(_mm512_castps128_ps512(a), b);
        _mm512_insertf32x4::<3>(_mm512_insertf32x4::<2>(ab, c), d)
    }

    /// As [`Near::sum`](super::Near::sum), from the contributions of four neighbours and of one.
    #[inline]
    #[target_feature(enable = "avx512f")]
    fn sum(links: &[Link], quad: impl Fn(&[Link; 4]) -> __m512, single: impl Fn(f32, usize) -> Vec4) -> Vec4 {
        let mut sum = _mm512_setzero_ps();
        let (quads, rest) = links.as_chunks::<4>();
        for links in quads {
            sum = _mm512_add_ps(sum, quad(links));
        }
        let mut sums = [
            Vec4::from(_mm512_extractf32x4_ps::<0>(sum)),
            Vec4::from(_mm512_extractf32x4_ps::<1>(sum)),
            Vec4::from(_mm512_extractf32x4_ps::<2>(sum)),
            Vec4::from(_mm512_extractf32x4_ps::<3>(sum)),
        ];
        for (sum, link) in sums.iter_mut().zip(rest) {
            *sum += single(link.factor, link.index());
        }
        (sums[0] + sums[1]) + (sums[2] + sums[3])
    }
}
