//! The registers of AVX2 and AVX-512.
//!
//! All intrinsics in this module are safe to call for one reason: values of the two register types exist only
//! inside a [`Leaf`] that [`with_avx2`] or [`with_avx512`] runs, after the processor's support has been
//! checked. No other function may name these types.

use std::arch::x86_64::*;
use std::ops::{Add, Div, Mul, Sub};

use super::{Lanes, Leaf, Register};

pub(super) fn has_avx2() -> bool {
    is_x86_feature_detected!("avx2") && is_x86_feature_detected!("popcnt")
}

pub(super) fn has_avx512() -> bool {
    has_avx2() && is_x86_feature_detected!("avx512f")
}

#[target_feature(enable = "avx2,popcnt")]
pub(super) fn with_avx2<L: Leaf>(leaf: L) {
    leaf.run::<F32x8>();
}

#[target_feature(enable = "avx512f,popcnt")]
pub(super) fn with_avx512<L: Leaf>(leaf: L) {
    leaf.run::<F32x16>();
}

/// A register of AVX.
#[derive(Clone, Copy)]
pub(super) struct F32x8(__m256);

/// A register of AVX-512.
#[derive(Clone, Copy)]
pub(super) struct F32x16(__m512);

macro_rules! operator {
    ($register:ident, $name:ident, $function:ident, $intrinsic:ident) => {
        impl $name for $register {
            type Output = Self;

            #[inline(always)]
            fn $function(self, other: Self) -> Self {
                // SAFETY: the processor supports the register, as explained at the top of this file.
                Self(unsafe { $intrinsic(self.0, other.0) })
            }
        }

        impl $name<f32> for $register {
            type Output = Self;

            #[inline(always)]
            fn $function(self, other: f32) -> Self {
                $name::$function(self, Self::splat(other))
            }
        }
    };
}
operator!(F32x8, Add, add, _mm256_add_ps);
operator!(F32x8, Sub, sub, _mm256_sub_ps);
operator!(F32x8, Mul, mul, _mm256_mul_ps);
operator!(F32x8, Div, div, _mm256_div_ps);
operator!(F32x16, Add, add, _mm512_add_ps);
operator!(F32x16, Sub, sub, _mm512_sub_ps);
operator!(F32x16, Mul, mul, _mm512_mul_ps);
operator!(F32x16, Div, div, _mm512_div_ps);

impl Lanes for F32x8 {
    #[inline(always)]
    fn splat(value: f32) -> Self {
        // SAFETY: the processor supports AVX2, because only a [`Leaf`] that runs there uses this type.
        Self(unsafe { _mm256_set1_ps(value) })
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        // SAFETY: the processor supports AVX2, because a value of this type exists.
        Self(unsafe { _mm256_sqrt_ps(self.0) })
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        // SAFETY: the processor supports AVX2, because a value of this type exists.
        Self(unsafe { _mm256_max_ps(self.0, other.0) })
    }

    #[inline(always)]
    fn if_less(self, bound: Self, yes: Self, no: Self) -> Self {
        // SAFETY: the processor supports AVX2, because a value of this type exists.
        Self(unsafe { _mm256_blendv_ps(no.0, yes.0, _mm256_cmp_ps::<_CMP_LT_OQ>(self.0, bound.0)) })
    }
}

impl Register for F32x8 {
    const WIDTH: usize = 8;

    #[inline(always)]
    unsafe fn load(from: *const f32) -> Self {
        // SAFETY: the processor supports AVX2; the caller guarantees a full register of numbers at `from`.
        Self(unsafe { _mm256_loadu_ps(from) })
    }

    #[inline(always)]
    unsafe fn store(self, to: *mut f32) {
        // SAFETY: the processor supports AVX2; the caller guarantees room for a full register at `to`.
        unsafe { _mm256_storeu_ps(to, self.0) }
    }

    #[inline(always)]
    fn less_bits(self, bound: Self) -> u32 {
        // SAFETY: the processor supports AVX2, because a value of this type exists.
        unsafe { _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LT_OQ>(self.0, bound.0)).cast_unsigned() }
    }

    #[inline(always)]
    fn compress(self, bits: u32) -> Self {
        let lanes = &COMPRESS[(bits & 255) as usize];
        // SAFETY: the processor supports AVX2, and a row of the table has eight numbers.
        Self(unsafe { _mm256_permutevar8x32_ps(self.0, _mm256_loadu_si256(lanes.as_ptr().cast())) })
    }
}

static COMPRESS: [[u32; 8]; 256] = super::compress_table();

impl Lanes for F32x16 {
    #[inline(always)]
    fn splat(value: f32) -> Self {
        // SAFETY: the processor supports AVX-512, because only a [`Leaf`] that runs there uses this type.
        Self(unsafe { _mm512_set1_ps(value) })
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        // SAFETY: the processor supports AVX-512, because a value of this type exists.
        Self(unsafe { _mm512_sqrt_ps(self.0) })
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        // SAFETY: the processor supports AVX-512, because a value of this type exists.
        Self(unsafe { _mm512_max_ps(self.0, other.0) })
    }

    #[inline(always)]
    fn if_less(self, bound: Self, yes: Self, no: Self) -> Self {
        // SAFETY: the processor supports AVX-512, because a value of this type exists.
        Self(unsafe { _mm512_mask_blend_ps(_mm512_cmp_ps_mask::<_CMP_LT_OQ>(self.0, bound.0), no.0, yes.0) })
    }
}

impl Register for F32x16 {
    const WIDTH: usize = 16;

    #[inline(always)]
    unsafe fn load(from: *const f32) -> Self {
        // SAFETY: the processor supports AVX-512; the caller guarantees a full register of numbers at `from`.
        Self(unsafe { _mm512_loadu_ps(from) })
    }

    #[inline(always)]
    unsafe fn store(self, to: *mut f32) {
        // SAFETY: the processor supports AVX-512; the caller guarantees room for a full register at `to`.
        unsafe { _mm512_storeu_ps(to, self.0) }
    }

    #[inline(always)]
    fn less_bits(self, bound: Self) -> u32 {
        // SAFETY: the processor supports AVX-512, because a value of this type exists.
        unsafe { u32::from(_mm512_cmp_ps_mask::<_CMP_LT_OQ>(self.0, bound.0)) }
    }

    #[inline(always)]
    fn compress(self, bits: u32) -> Self {
        // SAFETY: the processor supports AVX-512, because a value of this type exists.
        Self(unsafe { _mm512_maskz_compress_ps(bits as u16, self.0) })
    }
}
