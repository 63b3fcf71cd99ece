//! Arithmetic on a register of numbers, as wide as the processor has them.
//!
//! *How it works.* A formula is written once over [`Lanes`]; a `Leaf` is compiled for every kind of register, and
//! the widest of this processor is chosen while running (`target-cpu=native` would add nothing).
//!
//! *Why not* plain loops that the compiler vectorises: whether it does changes with an unrelated line, by a factor of
//! three. *Why not* a fused multiplication and addition: it saves a twentieth, and results would depend on the
//! processor.

mod portable;
#[cfg(test)]
mod tests;
#[cfg(target_arch = "x86_64")]
mod x86;

use std::ops::{Add, Div, Mul, Sub};
use std::sync::atomic::{AtomicU8, Ordering::Relaxed};

/// Numbers that are taken together: sums are kept in so many lanes whatever the width of the registers, so that the
/// order of every sum, and with it every bit, is the same on all processors.
pub(crate) const BLOCK: usize = 16;

/// A vector of numbers; `f32` is one of a single lane.
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
    /// The larger of each two lanes; that of `other` if one of both is NaN.
    fn max(self, other: Self) -> Self;
    /// Lane by lane: `yes` where `self < bound`, `no` elsewhere.
    fn if_less(self, bound: Self, yes: Self, no: Self) -> Self;
}

/// The [`Lanes`] of a whole register.
pub(crate) trait Register: Lanes {
    /// Number of lanes; divides [`BLOCK`].
    const WIDTH: usize;

    /// Reads `WIDTH` numbers.
    ///
    /// # Safety
    /// So many must lie at `from`.
    unsafe fn load(from: *const f32) -> Self;

    /// Writes `WIDTH` numbers.
    ///
    /// # Safety
    /// There must be room for so many at `to`.
    unsafe fn store(self, to: *mut f32);

    /// One bit for every lane that is below the bound.
    fn less_bits(self, bound: Self) -> u32;

    /// The lanes whose bit is set, moved to the front in their order; what follows them is anything.
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
    /// What every processor has: SSE2, NEON.
    Portable,
    /// AVX2.
    Avx2,
    /// AVX-512 (F).
    Avx512,
}

impl Simd {
    /// All kinds, narrowest first.
    pub const ALL: [Self; 3] = [Self::Portable, Self::Avx2, Self::Avx512];

    /// Its name as a person writes it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Portable => "portable",
            Self::Avx2 => "avx2",
            Self::Avx512 => "avx512",
        }
    }

    /// True if this processor has such registers.
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

    /// The kind that the loops of this process run with: the widest of this processor within
    /// [`limit`](Self::limit_to).
    pub fn in_use() -> Self {
        let limit = LIMIT.load(Relaxed);
        let fits = |kind: &Self| *kind as u8 <= limit && kind.is_available();
        Self::ALL.into_iter().rev().find(fits).unwrap_or(Self::Portable)
    }

    /// From now on, loops of this process use no wider kind. It changes no bit of any result, only the time: for
    /// measuring.
    pub fn limit_to(self) {
        LIMIT.store(self as u8, Relaxed);
    }
}

static LIMIT: AtomicU8 = AtomicU8::new(Simd::Avx512 as u8);

/// Work that is compiled for every kind of register. `run` must be `#[inline(always)]`, and so must be what it calls
/// with registers: only then are they registers.
pub(crate) trait Leaf {
    fn run<V: Register>(self);
}

/// Runs a leaf with registers of the kind, which this processor must have.
#[inline]
pub(crate) fn run_with<L: Leaf>(kind: Simd, leaf: L) {
    assert!(kind.is_available(), "this processor has no {} registers", kind.name());
    match kind {
        Simd::Portable => leaf.run::<portable::F32x4>(),
        // SAFETY: the processor has them.
        #[cfg(target_arch = "x86_64")]
        Simd::Avx2 => unsafe { x86::with_avx2(leaf) },
        // SAFETY: as above.
        #[cfg(target_arch = "x86_64")]
        Simd::Avx512 => unsafe { x86::with_avx512(leaf) },
        #[cfg(not(target_arch = "x86_64"))]
        Simd::Avx2 | Simd::Avx512 => unreachable!("asked above"),
    }
}

/// The sum of a block, always in the same order: halves are folded onto each other.
#[inline(always)]
pub(crate) fn sum(mut lanes: [f32; BLOCK]) -> f32 {
    let mut width = BLOCK;
    while width > 1 {
        width /= 2;
        for l in 0..width {
            lanes[l] += lanes[l + width];
        }
    }
    lanes[0]
}

/// For every set of lanes, by the bits of its number: the numbers of the lanes in it, and then anything.
const fn front<const LANES: usize, const SETS: usize>() -> [[u32; LANES]; SETS] {
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
