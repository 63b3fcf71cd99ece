//! Formulas of vectors of four components, evaluated for one neighbour or for four at once in registers of any width, with the
//! same results to the bit.

use std::ops::{Add, Mul, Sub};

use glam::{Vec4, Vec4Swizzles};

use super::near::Link;
use crate::simd::Simd;

/// One vector, or four.
pub(super) trait Vectors: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {
    /// A link for each vector.
    type Links<'a>: Copy;

    /// The same vector in all places.
    fn splat(vector: Vec4) -> Self;

    /// The factor of each link in all components of its vector.
    fn factors(links: Self::Links<'_>) -> Self;

    /// The vector of each link.
    ///
    /// # Safety
    /// The indices of the links must be below the number of vectors.
    unsafe fn gather(links: Self::Links<'_>, vectors: &[Vec4]) -> Self;

    /// The fourth component of each vector in all of its components.
    fn last(self) -> Self;

    /// The sum (x + y) + (z + w) of each vector in all of its components.
    fn totals(self) -> Self;
}

/// Four vectors, whose sums are independent.
trait Quad: for<'a> Vectors<Links<'a> = &'a [Link; 4]> {
    fn parts(self) -> [Vec4; 4];
}

/// What is added up over links.
pub(super) trait Formula {
    /// The contributions of links.
    fn of<Q: Vectors>(&self, links: Q::Links<'_>) -> Q;
}

/// The sum of a formula over links.
///
/// # Safety
/// The processor must have these registers.
#[inline]
pub(super) unsafe fn sum(simd: Simd, links: &[Link], formula: &impl Formula) -> Vec4 {
    match simd {
        // SAFETY: as for this function.
        #[cfg(target_arch = "x86_64")]
        Simd::Avx512 => unsafe { x86::with_avx512(links, formula) },
        // SAFETY: as for this function.
        #[cfg(target_arch = "x86_64")]
        Simd::Avx2 => unsafe { x86::with_avx2(links, formula) },
        _ => sum_in::<Four>(links, formula),
    }
}

/// Four partial sums, because an addition takes four cycles.
#[inline(always)]
fn sum_in<Q: Quad>(links: &[Link], formula: &impl Formula) -> Vec4 {
    let mut sum = Q::splat(Vec4::ZERO);
    let (quads, rest) = links.as_chunks::<4>();
    for quad in quads {
        sum = sum + formula.of::<Q>(quad);
    }
    let mut sums = sum.parts();
    for (sum, link) in sums.iter_mut().zip(rest) {
        *sum += formula.of::<Vec4>(link);
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3])
}

impl Vectors for Vec4 {
    type Links<'a> = &'a Link;

    #[inline(always)]
    fn splat(vector: Vec4) -> Self {
        vector
    }

    #[inline(always)]
    fn factors(link: &Link) -> Self {
        Self::splat(link.factor)
    }

    #[inline(always)]
    unsafe fn gather(link: &Link, vectors: &[Vec4]) -> Self {
        vectors[link.index()]
    }

    #[inline(always)]
    fn last(self) -> Self {
        self.wwww()
    }

    #[inline(always)]
    fn totals(self) -> Self {
        let pairs = self + self.yxwz();
        pairs + pairs.zwxy()
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

impl Vectors for Four {
    type Links<'a> = &'a [Link; 4];

    #[inline(always)]
    fn splat(vector: Vec4) -> Self {
        Self([vector; 4])
    }

    #[inline(always)]
    fn factors(links: &[Link; 4]) -> Self {
        Self(links.each_ref().map(Vec4::factors))
    }

    #[inline(always)]
    unsafe fn gather(links: &[Link; 4], vectors: &[Vec4]) -> Self {
        Self(links.each_ref().map(|link| vectors[link.index()]))
    }

    #[inline(always)]
    fn last(self) -> Self {
        Self(self.0.map(Vec4::last))
    }

    #[inline(always)]
    fn totals(self) -> Self {
        Self(self.0.map(Vec4::totals))
    }
}

impl Quad for Four {
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

    use super::{Formula, Link, Quad, Vectors, sum_in};

    #[target_feature(enable = "avx2")]
    pub(super) fn with_avx2(links: &[Link], formula: &impl Formula) -> Vec4 {
        sum_in::<Two>(links, formula)
    }

    #[target_feature(enable = "avx512f")]
    pub(super) fn with_avx512(links: &[Link], formula: &impl Formula) -> Vec4 {
        sum_in::<One>(links, formula)
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
        #[inline(always)]
        fn permuted<const ORDER: i32>(self) -> Self {
            // SAFETY: the processor supports AVX2, because a value of this type exists.
            unsafe { Self([_mm256_permute_ps::<ORDER>(self.0[0]), _mm256_permute_ps::<ORDER>(self.0[1])]) }
        }
    }

    impl One {
        #[inline(always)]
        fn permuted<const ORDER: i32>(self) -> Self {
            // SAFETY: the processor supports AVX-512, because a value of this type exists.
            unsafe { Self(_mm512_permute_ps::<ORDER>(self.0)) }
        }
    }

    impl Vectors for Two {
        type Links<'a> = &'a [Link; 4];

        #[inline(always)]
        fn splat(vector: Vec4) -> Self {
            // SAFETY: the processor supports AVX2, because only code below `with_avx2` uses this type.
            unsafe { Self([_mm256_setr_m128(vector.into(), vector.into()); 2]) }
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
        fn last(self) -> Self {
            self.permuted::<0b11_11_11_11>()
        }

        #[inline(always)]
        fn totals(self) -> Self {
            let pairs = self + self.permuted::<0b10_11_00_01>();
            pairs + pairs.permuted::<0b01_00_11_10>()
        }
    }

    impl Vectors for One {
        type Links<'a> = &'a [Link; 4];

        #[inline(always)]
        fn splat(vector: Vec4) -> Self {
            // SAFETY: the processor supports AVX-512, because only code below `with_avx512` uses this type.
            unsafe { Self(_mm512_broadcast_f32x4(vector.into())) }
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
        fn last(self) -> Self {
            self.permuted::<0b11_11_11_11>()
        }

        #[inline(always)]
        fn totals(self) -> Self {
            let pairs = self + self.permuted::<0b10_11_00_01>();
            pairs + pairs.permuted::<0b01_00_11_10>()
        }
    }

    impl Quad for Two {
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
