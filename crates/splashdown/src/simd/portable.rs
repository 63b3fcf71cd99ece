//! Four lanes, which compilers keep in one register with SSE2, NEON and WebAssembly.

use std::ops::{Add, Div, Mul, Sub};

use super::{Lanes, Register};

#[derive(Clone, Copy)]
pub(super) struct F32x4([f32; 4]);

impl F32x4 {
    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(f32, f32) -> f32) -> Self {
        let (a, b) = (self.0, other.0);
        Self([f(a[0], b[0]), f(a[1], b[1]), f(a[2], b[2]), f(a[3], b[3])])
    }
}

macro_rules! operator {
    ($name:ident, $function:ident, $operator:tt) => {
        impl $name for F32x4 {
            type Output = Self;

            #[inline(always)]
            fn $function(self, other: Self) -> Self {
                self.zip(other, |a, b| a $operator b)
            }
        }

        impl $name<f32> for F32x4 {
            type Output = Self;

            #[inline(always)]
            fn $function(self, other: f32) -> Self {
                self.zip(Self::splat(other), |a, b| a $operator b)
            }
        }
    };
}
operator!(Add, add, +);
operator!(Sub, sub, -);
operator!(Mul, mul, *);
operator!(Div, div, /);

impl Lanes for F32x4 {
    #[inline(always)]
    fn splat(value: f32) -> Self {
        Self([value; 4])
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.map(f32::sqrt))
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.zip(other, |a, b| if a > b { a } else { b })
    }

    #[inline(always)]
    fn if_less(self, bound: Self, yes: Self, no: Self) -> Self {
        Self(std::array::from_fn(|l| if self.0[l] < bound.0[l] { yes.0[l] } else { no.0[l] }))
    }
}

impl Register for F32x4 {
    const WIDTH: usize = 4;

    #[inline(always)]
    unsafe fn load(from: *const f32) -> Self {
        // SAFETY: the caller guarantees four readable numbers, and an array has the alignment of its items.
        Self(unsafe { *from.cast::<[f32; 4]>() })
    }

    #[inline(always)]
    unsafe fn store(self, to: *mut f32) {
        // SAFETY: the caller guarantees four writable numbers, and an array has the alignment of its items.
        unsafe { *to.cast::<[f32; 4]>() = self.0 }
    }

    #[inline(always)]
    fn less_bits(self, bound: Self) -> u32 {
        let bit = |l: usize| u32::from(self.0[l] < bound.0[l]) << l;
        bit(0) | bit(1) | bit(2) | bit(3)
    }

    #[inline(always)]
    fn compress(self, bits: u32) -> Self {
        Self(COMPRESS[(bits & 15) as usize].map(|lane| self.0[lane as usize & 3]))
    }
}

static COMPRESS: [[u32; 4]; 16] = super::compress_table();
