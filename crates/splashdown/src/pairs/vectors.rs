//! Formulas of vectors of four components, evaluated for four particles at once in registers of any width, with the same
//! results to the bit.

use std::ops::{Add, Mul, Sub};

use glam::{Vec4, Vec4Swizzles};

use super::near::Link;
use crate::simd::Simd;

/// Four vectors, one for each of four particles.
pub(crate) trait Quad: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {
    /// The same vector in all places.
    fn splat(vector: Vec4) -> Self;

    /// Four vectors from memory.
    fn load(vectors: &[Vec4; 4]) -> Self;

    /// The factor of each link in all components of its vector.
    fn factors(links: &[Link; 4]) -> Self;

    /// The vector of each link.
    ///
    /// # Safety
    /// The indices of the links must be below the number of vectors.
    unsafe fn gather(links: &[Link; 4], vectors: &[Vec4]) -> Self;

    /// Four pairs of vectors from memory: the first vectors, and the second ones.
    fn load_pairs(pairs: &[[Vec4; 2]; 4]) -> [Self; 2];

    /// The pair of vectors of each link: the first vectors, and the second ones. A pair is loaded at once.
    ///
    /// # Safety
    /// The indices of the links must be below the number of pairs.
    unsafe fn gather_pairs(links: &[Link; 4], pairs: &[[Vec4; 2]]) -> [Self; 2];

    /// The fourth component of each vector in all of its components.
    fn last(self) -> Self;

    /// The sum (x + y) + (z + w) of each vector in all of its components.
    fn totals(self) -> Self;

    /// The vectors.
    fn parts(self) -> [Vec4; 4];
}

/// Code that is compiled for every kind of register. `run` and all functions that it calls with registers must be
/// `#[inline(always)]`: otherwise the values are passed in memory.
pub(super) trait QuadLeaf {
    fn run<Q: Quad>(self);
}

/// Runs a leaf with registers of the given kind. Panics if the processor does not support it.
#[inline]
pub(super) fn run_with(simd: Simd, leaf: impl QuadLeaf) {
    assert!(simd.is_available(), "this processor has no {} registers", simd.name());
    match simd {
        // SAFETY: the assertion above checks that the processor supports them.
        #[cfg(target_arch = "x86_64")]
        Simd::Avx512 => unsafe { x86::with_avx512(leaf) },
        // SAFETY: as above.
        #[cfg(target_arch = "x86_64")]
        Simd::Avx2 => unsafe { x86::with_avx2(leaf) },
        _ => leaf.run::<Four>(),
    }
}

/// Four registers of one vector, on every processor.
#[derive(Clone, Copy)]
struct Four([Vec4; 4]);

impl Four {
    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(Vec4, Vec4) -> Vec4) -> Self {
        let (a, b) = (self.0, other.0);
        Self([f(a[0], b[0]), f(a[1], b[1]), f(a[2], b[2]), f(a[3], b[3])])
    }
}

impl Add for Four {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.zip(other, |a, b| a + b)
    }
}

impl Sub for Four {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.zip(other, |a, b| a - b)
    }
}

impl Mul for Four {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.zip(other, |a, b| a * b)
    }
}

impl Quad for Four {
    #[inline(always)]
    fn splat(vector: Vec4) -> Self {
        Self([vector; 4])
    }

    #[inline(always)]
    fn load(vectors: &[Vec4; 4]) -> Self {
        Self(*vectors)
    }

    #[inline(always)]
    fn factors(links: &[Link; 4]) -> Self {
        Self(links.each_ref().map(|link| Vec4::splat(link.factor)))
    }

    #[inline(always)]
    unsafe fn gather(links: &[Link; 4], vectors: &[Vec4]) -> Self {
        Self(links.each_ref().map(|link| vectors[link.index()]))
    }

    #[inline(always)]
    fn load_pairs(pairs: &[[Vec4; 2]; 4]) -> [Self; 2] {
        [Self(pairs.map(|[first, _]| first)), Self(pairs.map(|[_, second]| second))]
    }

    #[inline(always)]
    unsafe fn gather_pairs(links: &[Link; 4], pairs: &[[Vec4; 2]]) -> [Self; 2] {
        Self::load_pairs(&links.each_ref().map(|link| pairs[link.index()]))
    }

    #[inline(always)]
    fn last(self) -> Self {
        Self(self.0.map(Vec4Swizzles::wwww))
    }

    #[inline(always)]
    fn totals(self) -> Self {
        let pairs = Self(self.0.map(|v| v + v.yxwz()));
        Self(pairs.0.map(|v| v + v.zwxy()))
    }

    #[inline(always)]
    fn parts(self) -> [Vec4; 4] {
        self.0
    }
}

/// The registers of AVX2 and AVX-512.
///
/// All intrinsics in this module are safe to call for one reason: values of the two register types exist only below
/// [`with_avx2`](x86::with_avx2) and [`with_avx512`](x86::with_avx512), whose callers have checked the processor.
#[cfg(target_arch = "x86_64")]
mod x86 {
    use std::arch::x86_64::*;
    use std::ops::{Add, Mul, Sub};

    use glam::Vec4;

    use super::{Link, Quad, QuadLeaf};

    #[target_feature(enable = "avx2")]
    pub(super) fn with_avx2(leaf: impl QuadLeaf) {
        leaf.run::<Two>();
    }

    #[target_feature(enable = "avx512f")]
    pub(super) fn with_avx512(leaf: impl QuadLeaf) {
        leaf.run::<One>();
    }

    /// The vector of a link.
    ///
    /// # Safety
    /// The index of the link must be below the number of vectors.
    #[inline(always)]
    unsafe fn vector(link: &Link, vectors: &[Vec4]) -> __m128 {
        // SAFETY: a reference is valid. The read is volatile because the compiler would otherwise take the place out of a
        // register into which it has loaded the factors of several links, which takes twice as many instructions.
        let place = unsafe { std::ptr::read_volatile(&link.place) } as usize;
        // SAFETY: the place is twice the index, in units of half a vector; every x86-64 processor has SSE.
        unsafe { _mm_load_ps(vectors.as_ptr().cast::<[f32; 2]>().add(place).cast()) }
    }

    /// Two registers of two vectors.
    #[derive(Clone, Copy)]
    struct Two([__m256; 2]);

    /// One register of four vectors.
    #[derive(Clone, Copy)]
    struct One(__m512);

    /// The pair of a link.
    ///
    /// # Safety
    /// The index of the link must be below the number of pairs.
    #[inline(always)]
    unsafe fn pair(link: &Link, pairs: &[[Vec4; 2]]) -> *const f32 {
        // SAFETY: a reference is valid; volatile as in `vector`.
        let place = unsafe { std::ptr::read_volatile(&link.place) } as usize;
        // SAFETY: the place is twice the index, in units of half a pair.
        unsafe { pairs.as_ptr().cast::<Vec4>().add(place).cast() }
    }

    macro_rules! operator {
        ($name:ident, $function:ident, $of_two:ident, $of_one:ident) => {
            impl $name for Two {
                type Output = Self;

                #[inline(always)]
                fn $function(self, other: Self) -> Self {
                    // SAFETY: the processor supports AVX2, because values of this type exist.
                    unsafe { Self([$of_two(self.0[0], other.0[0]), $of_two(self.0[1], other.0[1])]) }
                }
            }

            impl $name for One {
                type Output = Self;

                #[inline(always)]
                fn $function(self, other: Self) -> Self {
                    // SAFETY: the processor supports AVX-512, because values of this type exist.
                    unsafe { Self($of_one(self.0, other.0)) }
                }
            }
        };
    }
    operator!(Add, add, _mm256_add_ps, _mm512_add_ps);
    operator!(Sub, sub, _mm256_sub_ps, _mm512_sub_ps);
    operator!(Mul, mul, _mm256_mul_ps, _mm512_mul_ps);

    impl Two {
        /// The first and the second vectors of four pairs.
        ///
        /// # Safety
        /// The addresses must be valid for reads of eight numbers.
        #[inline(always)]
        unsafe fn from_pairs(pairs: [*const f32; 4]) -> [Self; 2] {
            // SAFETY: the processor supports AVX2, because only code below `with_avx2` uses this type; the caller
            // guarantees the addresses.
            unsafe {
                let [a, b, c, d] = pairs.map(|pair| _mm256_loadu_ps(pair));
                [
                    Self([_mm256_permute2f128_ps::<0x20>(a, b), _mm256_permute2f128_ps::<0x20>(c, d)]),
                    Self([_mm256_permute2f128_ps::<0x31>(a, b), _mm256_permute2f128_ps::<0x31>(c, d)]),
                ]
            }
        }

        #[inline(always)]
        fn permuted<const ORDER: i32>(self) -> Self {
            // SAFETY: the processor supports AVX2, because a value of this type exists.
            unsafe { Self([_mm256_permute_ps::<ORDER>(self.0[0]), _mm256_permute_ps::<ORDER>(self.0[1])]) }
        }
    }

    impl One {
        /// The first and the second vectors of four pairs.
        ///
        /// # Safety
        /// The addresses must be valid for reads of eight numbers.
        #[inline(always)]
        unsafe fn from_pairs(pairs: [*const f32; 4]) -> [Self; 2] {
            // SAFETY: the processor supports AVX-512, because only code below `with_avx512` uses this type; the caller
            // guarantees the addresses.
            unsafe {
                let two = |first: *const f32, second: *const f32| {
                    let first = _mm512_castpd256_pd512(_mm256_loadu_pd(first.cast()));
                    _mm512_castpd_ps(_mm512_insertf64x4::<1>(first, _mm256_loadu_pd(second.cast())))
                };
                let [a, b, c, d] = pairs;
                let (ab, cd) = (two(a, b), two(c, d));
                [
                    Self(_mm512_shuffle_f32x4::<0b10_00_10_00>(ab, cd)),
                    Self(_mm512_shuffle_f32x4::<0b11_01_11_01>(ab, cd)),
                ]
            }
        }

        #[inline(always)]
        fn permuted<const ORDER: i32>(self) -> Self {
            // SAFETY: the processor supports AVX-512, because a value of this type exists.
            unsafe { Self(_mm512_permute_ps::<ORDER>(self.0)) }
        }
    }

    impl Quad for Two {
        #[inline(always)]
        fn splat(vector: Vec4) -> Self {
            // SAFETY: the processor supports AVX2, because only code below `with_avx2` uses this type.
            unsafe { Self([_mm256_setr_m128(vector.into(), vector.into()); 2]) }
        }

        #[inline(always)]
        fn load(vectors: &[Vec4; 4]) -> Self {
            let from = vectors.as_ptr().cast::<f32>();
            // SAFETY: the processor supports AVX2, because only code below `with_avx2` uses this type; four vectors are
            // sixteen numbers.
            unsafe { Self([_mm256_loadu_ps(from), _mm256_loadu_ps(from.add(8))]) }
        }

        #[inline(always)]
        fn factors([a, b, c, d]: &[Link; 4]) -> Self {
            // SAFETY: the processor supports AVX2, because only code below `with_avx2` uses this type.
            unsafe {
                let [a, b, c, d] = [
                    _mm256_broadcast_ss(&a.factor),
                    _mm256_broadcast_ss(&b.factor),
                    _mm256_broadcast_ss(&c.factor),
                    _mm256_broadcast_ss(&d.factor),
                ];
                Self([_mm256_blend_ps::<0xf0>(a, b), _mm256_blend_ps::<0xf0>(c, d)])
            }
        }

        #[inline(always)]
        unsafe fn gather([a, b, c, d]: &[Link; 4], vectors: &[Vec4]) -> Self {
            // SAFETY: the processor supports AVX2, because only code below `with_avx2` uses this type; the caller
            // guarantees the indices.
            unsafe {
                Self([
                    _mm256_setr_m128(vector(a, vectors), vector(b, vectors)),
                    _mm256_setr_m128(vector(c, vectors), vector(d, vectors)),
                ])
            }
        }

        #[inline(always)]
        fn load_pairs(pairs: &[[Vec4; 2]; 4]) -> [Self; 2] {
            // SAFETY: a pair has eight numbers.
            unsafe { Self::from_pairs(pairs.each_ref().map(|pair| pair.as_ptr().cast())) }
        }

        #[inline(always)]
        unsafe fn gather_pairs(links: &[Link; 4], pairs: &[[Vec4; 2]]) -> [Self; 2] {
            // SAFETY: the caller guarantees the indices; a pair has eight numbers.
            unsafe { Self::from_pairs(links.each_ref().map(|link| pair(link, pairs))) }
        }

        #[inline(always)]
        fn last(self) -> Self {
            self.permuted::<0b11_11_11_11>()
        }

        #[inline(always)]
        fn totals(self) -> Self {
            let pairs = self + self.permuted::<0b10_11_00_01>();
            pairs + pairs.permuted::<0b01_00_11_10>()
        }

        #[inline(always)]
        fn parts(self) -> [Vec4; 4] {
            let [ab, cd] = self.0;
            // SAFETY: the processor supports AVX2, because a value of this type exists.
            unsafe {
                [
                    _mm256_castps256_ps128(ab).into(),
                    _mm256_extractf128_ps::<1>(ab).into(),
                    _mm256_castps256_ps128(cd).into(),
                    _mm256_extractf128_ps::<1>(cd).into(),
                ]
            }
        }
    }

    impl Quad for One {
        #[inline(always)]
        fn splat(vector: Vec4) -> Self {
            // SAFETY: the processor supports AVX-512, because only code below `with_avx512` uses this type.
            unsafe { Self(_mm512_broadcast_f32x4(vector.into())) }
        }

        #[inline(always)]
        fn load(vectors: &[Vec4; 4]) -> Self {
            // SAFETY: the processor supports AVX-512, because only code below `with_avx512` uses this type; four vectors
            // are sixteen numbers.
            unsafe { Self(_mm512_loadu_ps(vectors.as_ptr().cast())) }
        }

        #[inline(always)]
        fn factors(links: &[Link; 4]) -> Self {
            // SAFETY: the processor supports AVX-512, because only code below `with_avx512` uses this type; four links have
            // the size of eight numbers.
            unsafe {
                let of_all = _mm512_setr_epi32(0, 0, 0, 0, 2, 2, 2, 2, 4, 4, 4, 4, 6, 6, 6, 6);
                let links = _mm256_loadu_ps(links.as_ptr().cast::<f32>());
                Self(_mm512_permutexvar_ps(of_all, _mm512_castps256_ps512(links)))
            }
        }

        #[inline(always)]
        unsafe fn gather([a, b, c, d]: &[Link; 4], vectors: &[Vec4]) -> Self {
            // SAFETY: the processor supports AVX-512, because only code below `with_avx512` uses this type; the caller
            // guarantees the indices.
            unsafe {
                let first = _mm512_castps128_ps512(vector(a, vectors));
                let two = _mm512_insertf32x4::<1>(first, vector(b, vectors));
                let three = _mm512_insertf32x4::<2>(two, vector(c, vectors));
                Self(_mm512_insertf32x4::<3>(three, vector(d, vectors)))
            }
        }

        #[inline(always)]
        fn load_pairs(pairs: &[[Vec4; 2]; 4]) -> [Self; 2] {
            // SAFETY: a pair has eight numbers.
            unsafe { Self::from_pairs(pairs.each_ref().map(|pair| pair.as_ptr().cast())) }
        }

        #[inline(always)]
        unsafe fn gather_pairs(links: &[Link; 4], pairs: &[[Vec4; 2]]) -> [Self; 2] {
            // SAFETY: the caller guarantees the indices; a pair has eight numbers.
            unsafe { Self::from_pairs(links.each_ref().map(|link| pair(link, pairs))) }
        }

        #[inline(always)]
        fn last(self) -> Self {
            self.permuted::<0b11_11_11_11>()
        }

        #[inline(always)]
        fn totals(self) -> Self {
            let pairs = self + self.permuted::<0b10_11_00_01>();
            pairs + pairs.permuted::<0b01_00_11_10>()
        }

        #[inline(always)]
        fn parts(self) -> [Vec4; 4] {
            // SAFETY: the processor supports AVX-512, because a value of this type exists.
            unsafe {
                [
                    _mm512_extractf32x4_ps::<0>(self.0).into(),
                    _mm512_extractf32x4_ps::<1>(self.0).into(),
                    _mm512_extractf32x4_ps::<2>(self.0).into(),
                    _mm512_extractf32x4_ps::<3>(self.0).into(),
                ]
            }
        }
    }
}
