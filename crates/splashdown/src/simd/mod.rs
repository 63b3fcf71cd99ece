//! SIMD arithmetic in registers of the width that the processor supports.
//!
//! *How it works.* A formula is written once over [`Lanes`]. A `Leaf` is compiled for every kind of register,
//! and the widest one that the processor supports is selected at run time (`target-cpu=native` has no further
//! effect).
//!
//! *Why not* rely on automatic vectorisation: unrelated changes to the code can disable it, which costs a
//! factor of three. *Why not* use fused multiply-add: it saves a twentieth of the time, and results would
//! depend on the processor.

mod portable;
#[cfg(test)]
mod tests;
#[cfg(target_arch = "x86_64")]
mod x86;

use std::ops::{Add, Div, Mul, Sub};
use std::sync::atomic::{AtomicU8, Ordering::Relaxed};

use glam::{Mat4, Vec4};

/// Number of lanes of a block. Sums are accumulated in this many lanes for any width of the registers, so
/// that the order of additions, and therefore every bit of the result, is the same on all processors.
pub(crate) const BLOCK: usize = 16;

/// A vector of numbers; `f32` is a vector of one lane.
pub trait Lanes:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Add<f32, Output = Self>
    + Sub<f32, Output = Self>
    + Mul<f32, Output = Self>
{
    /// The same number in every lane.
    fn splat(value: f32) -> Self;
    /// The square root of each lane.
    fn sqrt(self) -> Self;
    /// The lane-wise maximum; the lane of `other` if either is NaN.
    fn max(self, other: Self) -> Self;
    /// Selects lane by lane: `yes` where `self < bound`, `no` elsewhere.
    fn if_less(self, bound: Self, yes: Self, no: Self) -> Self;
}

/// The [`Lanes`] of a whole register.
pub(crate) trait Register: Lanes {
    /// Number of lanes; divides [`BLOCK`].
    const WIDTH: usize;

    /// Reads `WIDTH` numbers.
    ///
    /// # Safety
    /// `from` must be valid for reads of `WIDTH` numbers.
    unsafe fn load(from: *const f32) -> Self;

    /// Writes `WIDTH` numbers.
    ///
    /// # Safety
    /// `to` must be valid for writes of `WIDTH` numbers.
    unsafe fn store(self, to: *mut f32);

    /// A bit mask of the lanes that are below the bound.
    fn less_bits(self, bound: Self) -> u32;

    /// Moves the lanes whose bit is set to the front, in order. The remaining lanes are unspecified.
    fn compress(self, bits: u32) -> Self;
}

impl Lanes for f32 {
    #[inline(always)]
    fn splat(value: f32) -> Self {
        value
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        f32::sqrt(self)
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        if self > other { self } else { other }
    }

    #[inline(always)]
    fn if_less(self, bound: Self, yes: Self, no: Self) -> Self {
        if self < bound { yes } else { no }
    }
}

/// Kinds of registers, narrowest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum Simd {
    /// Four lanes, available on every processor (SSE2, NEON).
    Portable,
    /// AVX2.
    Avx2,
    /// AVX-512 (F).
    Avx512,
}

impl Simd {
    /// All kinds, narrowest first.
    pub const ALL: [Self; 3] = [Self::Portable, Self::Avx2, Self::Avx512];

    /// The name in lower case.
    pub fn name(self) -> &'static str {
        match self {
            Self::Portable => "portable",
            Self::Avx2 => "avx2",
            Self::Avx512 => "avx512",
        }
    }

    /// True if this processor supports this kind.
    pub fn is_available(self) -> bool {
        match self {
            Self::Portable => true,
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => x86::has_avx2(),
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => x86::has_avx512(),
            #[cfg(not(target_arch = "x86_64"))]
            Self::Avx2 | Self::Avx512 => false,
        }
    }

    /// The kind that this process uses: the widest one of the processor that does not exceed the
    /// [limit](Self::limit_to).
    pub fn in_use() -> Self {
        let limit = LIMIT.load(Relaxed);
        let fits = |kind: &Self| *kind as u8 <= limit && kind.is_available();
        Self::ALL.into_iter().rev().find(fits).unwrap_or(Self::Portable)
    }

    /// Limits the registers of this process to this kind, for measurements. Results stay bit-identical.
    pub fn limit_to(self) {
        LIMIT.store(self as u8, Relaxed);
    }
}

static LIMIT: AtomicU8 = AtomicU8::new(Simd::Avx512 as u8);

/// Code that is compiled for every kind of register. `run` and all functions that it calls with registers
/// must be `#[inline(always)]`: otherwise the values are passed in memory.
pub(crate) trait Leaf {
    fn run<V: Register>(self);
}

/// Runs a leaf with registers of the given kind. Panics if the processor does not support it.
#[inline]
pub(crate) fn run_with<L: Leaf>(kind: Simd, leaf: L) {
    assert!(kind.is_available(), "this processor has no {} registers", kind.name());
    match kind {
        Simd::Portable => leaf.run::<portable::F32x4>(),
        // SAFETY: the assertion above checks that the processor supports them.
        #[cfg(target_arch = "x86_64")]
        Simd::Avx2 => unsafe { x86::with_avx2(leaf) },
        // SAFETY: as above.
        #[cfg(target_arch = "x86_64")]
        Simd::Avx512 => unsafe { x86::with_avx512(leaf) },
        #[cfg(not(target_arch = "x86_64"))]
        Simd::Avx2 | Simd::Avx512 => unreachable!("checked by the assertion above"),
    }
}

/// The sum of every block in a fixed order: the upper half is added to the lower half, until one lane is left. Four blocks
/// at a time take a tenth of the time of one after the other.
#[inline(always)]
pub(crate) fn sums<const S: usize>(blocks: &[[f32; BLOCK]; S]) -> [f32; S] {
    let mut totals = [0.0; S];
    for (totals, blocks) in totals.chunks_mut(4).zip(blocks.chunks(4)) {
        let mut quarters = [Vec4::ZERO; 4];
        for (quarter, block) in quarters.iter_mut().zip(blocks) {
            let part = |k: usize| Vec4::from_slice(&block[4 * k..4 * k + 4]);
            *quarter = (part(0) + part(2)) + (part(1) + part(3));
        }
        let [a, b, c, d] = quarters;
        let lanes = Mat4::from_cols(a, b, c, d).transpose();
        let sum = (lanes.x_axis + lanes.z_axis) + (lanes.y_axis + lanes.w_axis);
        totals.copy_from_slice(&sum.to_array()[..totals.len()]);
    }
    totals
}

/// A table for [`Register::compress`]. The entry of a bit mask starts with the indices of the lanes whose bit
/// is set.
const fn compress_table<const LANES: usize, const SETS: usize>() -> [[u32; LANES]; SETS] {
    let mut table = [[0; LANES]; SETS];
    let mut set = 0;
    while set < SETS {
        let (mut lane, mut n) = (0, 0);
        while lane < LANES {
            if set >> lane & 1 == 1 {
                table[set][n] = lane as u32;
                n += 1;
            }
            lane += 1;
        }
        set += 1;
    }
    table
}
