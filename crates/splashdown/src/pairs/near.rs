//! Sums over the neighbours in a list.

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

/// The neighbours of a particle, or its images behind walls that are: for each a vector, and the bits of the index.
#[derive(Clone, Copy)]
pub(crate) struct Near<'a>(&'a [Vec4]);

/// The index of a neighbour.
#[inline(always)]
fn index(neighbour: &Vec4) -> usize {
    (neighbour.w.to_bits() & ((1 << INDEX_BITS) - 1)) as usize
}

impl<'a> Near<'a> {
    pub(super) fn new(neighbours: &'a [Vec4]) -> Self {
        Self(neighbours)
    }

    /// The sum of the vectors in the list times `own` plus the value of each neighbour.
    #[inline]
    pub fn sum_of_values(self, simd: Simd, own: f32, values: &[f32]) -> Vec4 {
        #[cfg(target_arch = "x86_64")]
        if simd >= Simd::Avx2 {
            // SAFETY: the processor has AVX2.
            return unsafe { avx2::sum_of_values(self, own, values) };
        }
        let _ = simd;
        self.sum(|vector, j| (own + values[j]) * vector)
    }

    /// The sum of the vectors in the list times, component by component, `own` minus the vector of each neighbour.
    #[inline]
    pub fn sum_of_differences(self, simd: Simd, own: Vec4, others: &[Vec4]) -> Vec4 {
        #[cfg(target_arch = "x86_64")]
        if simd >= Simd::Avx2 {
            // SAFETY: the processor has AVX2.
            return unsafe { avx2::sum_of_differences(self, own, others) };
        }
        let _ = simd;
        self.sum(|vector, j| vector * (own - others[j]))
    }

    /// The sum of the projections of `own` minus the vector of each neighbour on the neighbour's vector in the list: s (s.(own
    /// - other)). The fourth components must be zero.
    #[inline]
    pub fn sum_of_projections(self, simd: Simd, own: Vec4, others: &[Vec4]) -> Vec4 {
        #[cfg(target_arch = "x86_64")]
        if simd >= Simd::Avx2 {
            // SAFETY: the processor has AVX2.
            return unsafe { avx2::sum_of_projections(self, own, others) };
        }
        let _ = simd;
        self.sum(|s, j| projected(s, own - others[j]))
    }

    /// Of images: the vector in the list, whose fourth component has no meaning, the signs of a reflected vector, and the
    /// index.
    #[inline(always)]
    pub fn images(self) -> impl Iterator<Item = (Vec4, Vec4, usize)> {
        let axes = |neighbour: &Vec4| (neighbour.w.to_bits() >> INDEX_BITS & 7) as usize;
        self.0.iter().map(move |neighbour| (*neighbour, SIGNS[axes(neighbour)], index(neighbour)))
    }

    /// The sum of a contribution of each neighbour, from its vector and its index. Four partial sums, because an addition
    /// takes four cycles.
    #[inline(always)]
    fn sum(self, contribution: impl Fn(Vec4, usize) -> Vec4) -> Vec4 {
        let mut sums = [Vec4::ZERO; 4];
        let (quads, rest) = self.0.as_chunks::<4>();
        for quad in quads {
            for (sum, neighbour) in sums.iter_mut().zip(quad) {
                *sum += contribution(*neighbour, index(neighbour));
            }
        }
        for (sum, neighbour) in sums.iter_mut().zip(rest) {
            *sum += contribution(*neighbour, index(neighbour));
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

/// Two neighbours per register, with the same results to the bit.
#[cfg(target_arch = "x86_64")]
mod avx2 {
    use std::arch::x86_64::{
        __m256, _mm256_add_ps, _mm256_blend_ps, _mm256_castps256_ps128, _mm256_extractf128_ps,
        _mm256_loadu_ps, _mm256_mul_ps, _mm256_permute_ps, _mm256_set1_ps, _mm256_setr_m128,
        _mm256_setzero_ps, _mm256_sub_ps,
    };

    use glam::Vec4;

    use super::{Near, index, projected};

    #[target_feature(enable = "avx2")]
    pub(super) fn sum_of_values(near: Near<'_>, own: f32, values: &[f32]) -> Vec4 {
        let own_2 = _mm256_set1_ps(own);
        let pair = |vectors, i: usize, j: usize| {
            let of_both = _mm256_blend_ps::<0xf0>(_mm256_set1_ps(values[i]), _mm256_set1_ps(values[j]));
            _mm256_mul_ps(_mm256_add_ps(own_2, of_both), vectors)
        };
        sum(near, pair, |vector, j| (own + values[j]) * vector)
    }

    #[target_feature(enable = "avx2")]
    pub(super) fn sum_of_differences(near: Near<'_>, own: Vec4, others: &[Vec4]) -> Vec4 {
        let own_2 = _mm256_setr_m128(own.into(), own.into());
        let pair = |vectors, i: usize, j: usize| {
            let of_both = _mm256_setr_m128(others[i].into(), others[j].into());
            _mm256_mul_ps(vectors, _mm256_sub_ps(own_2, of_both))
        };
        sum(near, pair, |vector, j| vector * (own - others[j]))
    }

    #[target_feature(enable = "avx2")]
    pub(super) fn sum_of_projections(near: Near<'_>, own: Vec4, others: &[Vec4]) -> Vec4 {
        let own_2 = _mm256_setr_m128(own.into(), own.into());
        let pair = |s, i: usize, j: usize| {
            let of_both = _mm256_setr_m128(others[i].into(), others[j].into());
            let p = _mm256_mul_ps(s, _mm256_sub_ps(own_2, of_both));
            let pairs = _mm256_add_ps(p, _mm256_permute_ps::<0b10_11_00_01>(p));
            _mm256_mul_ps(s, _mm256_add_ps(pairs, _mm256_permute_ps::<0b01_00_11_10>(pairs)))
        };
        sum(near, pair, |s, j| projected(s, own - others[j]))
    }

    /// As [`Near::sum`], from the contributions of two neighbours and of one.
    #[inline]
    #[target_feature(enable = "avx2")]
    fn sum(
        near: Near<'_>,
        pair: impl Fn(__m256, usize, usize) -> __m256,
        single: impl Fn(Vec4, usize) -> Vec4,
    ) -> Vec4 {
        let mut sums = [_mm256_setzero_ps(); 2];
        let (quads, rest) = near.0.as_chunks::<4>();
        for quad in quads {
            for (sum, both) in sums.iter_mut().zip(quad.as_chunks::<2>().0) {
                // SAFETY: a pair has the size of the register.
                let vectors = unsafe { _mm256_loadu_ps(both.as_ptr().cast::<f32>()) };
                *sum = _mm256_add_ps(*sum, pair(vectors, index(&both[0]), index(&both[1])));
            }
        }
        let [a, b] = sums.map(|sum| {
            [Vec4::from(_mm256_castps256_ps128(sum)), Vec4::from(_mm256_extractf128_ps::<1>(sum))]
        });
        let mut sums = [a[0], a[1], b[0], b[1]];
        for (sum, neighbour) in sums.iter_mut().zip(rest) {
            *sum += single(*neighbour, index(neighbour));
        }
        (sums[0] + sums[1]) + (sums[2] + sums[3])
    }
}
