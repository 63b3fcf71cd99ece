//! The range of the implicit pressure of particles, and its residual there (see the [module](super)).

use super::{LARGEST_HELD, LARGEST_REMOVED, LEAST_REMOVED};
use crate::simd::Lanes;

/// What determines the residual of particles, besides the change of their density in the step.
#[derive(Clone, Copy)]
pub(super) struct Limits<V> {
    /// The smallest k, in m^2/s^2: zero, or minus the limit of the tension.
    least: V,
    /// The excess of density that a pressure above zero takes away.
    pushed: V,
    /// The excess of density that a pressure below zero takes away.
    pulled: V,
}

/// The smaller of both; `other` if either is NaN.
#[inline(always)]
pub(super) fn smaller<V: Lanes>(one: V, other: V) -> V {
    one.if_less(other, one, other)
}

/// The largest excess of density that a step removes, for its length over that of the longest step.
#[inline(always)]
pub(super) fn most_removed(tolerance: f32, dt_ratio: f32) -> f32 {
    LEAST_REMOVED.max(2.0 * tolerance) + LARGEST_REMOVED * dt_ratio * dt_ratio
}

impl<V: Lanes> Limits<V> {
    /// Of particles that cannot be under tension.
    #[inline(always)]
    pub fn of(excess: V) -> Self {
        Self { least: V::splat(0.0), pushed: excess, pulled: excess }
    }

    /// Of particles inside the fluid, where this part of a deficit of density closes in the step.
    #[inline(always)]
    pub fn inside(tension_limit: f32, closing: f32, excess: V) -> Self {
        let zero = V::splat(0.0);
        let closed = (excess * closing).max(excess);
        let held = smaller(closed, excess + LARGEST_HELD);
        Self {
            least: V::splat(-tension_limit),
            pushed: excess.if_less(zero, held, excess),
            pulled: excess.if_less(zero, closed, excess),
        }
    }

    /// These where `a` is below `b`, others elsewhere.
    #[inline(always)]
    pub fn where_less(self, a: V, b: V, others: Self) -> Self {
        let select = |these, others| a.if_less(b, these, others);
        Self {
            least: select(self.least, others.least),
            pushed: select(self.pushed, others.pushed),
            pulled: select(self.pulled, others.pulled),
        }
    }

    /// The residual at the pressure `k`, for the other terms of it: the change of the density in the step, less the
    /// compression.
    #[inline(always)]
    pub fn residual(&self, k: V, change: V) -> V {
        let zero = V::splat(0.0);
        let (pushed, pulled) = (self.pushed + change, self.pulled + change);
        let of_none = zero.if_less(pushed, pushed, pulled.if_less(zero, pulled, zero));
        zero.if_less(k, pushed, k.if_less(zero, pulled, of_none))
    }

    /// The pressure after `k`, for the other terms of the residual.
    #[inline(always)]
    pub fn next(&self, k: V, change: V, relaxation: f32, diagonal: V) -> V {
        let zero = V::splat(0.0);
        let moved = |excess: V| k + (excess + change) * relaxation / diagonal;
        let (positive, negative) = (moved(self.pushed), moved(self.pulled));
        zero.if_less(positive, positive, smaller(negative, zero).max(self.least))
    }

    /// The error of `k` in units of the residual: zero if the pressure would have to leave its range to make the residual
    /// smaller.
    #[inline(always)]
    pub fn error(&self, k: V, residual: V, diagonal: V) -> V {
        let size = residual.max(V::splat(0.0) - residual);
        self.least.if_less(k, size, residual.max(diagonal * (self.least - k)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_small_deficit_is_held_and_a_larger_one_closes_freely() {
        // A deficit of 1 % that closes by 0.5 %, at rest, and that opens by 0.5 %.
        let small = Limits::inside(1.0, 0.1, -0.01);
        assert!(small.residual(0.0, 0.005) > 0.0);
        assert!(small.residual(0.0, -0.005) < 0.0);
        // One of 10 %: only the further opening has a residual.
        let large = Limits::inside(1.0, 0.1, -0.1);
        assert_eq!(large.residual(0.0, 0.05), 0.0);
        assert!(large.residual(0.0, 0.09) > 0.0);
        assert!(large.residual(0.0, -0.05) < 0.0);
        assert!(Limits::of(-0.01).residual(0.0, 0.005) < 0.0, "control: at the surface");
    }

    #[test]
    fn the_next_pressure_has_the_residual_of_its_sign_and_keeps_the_limit() {
        let limits = Limits::inside(1.0, 0.1, -0.1);
        let next = |k, change| limits.next(k, change, 0.5, 2.0);
        assert!((next(0.5, 0.0) - 0.48).abs() < 1e-6, "less a quarter of the deficit above 2 %");
        assert_eq!(next(0.0, 0.05), 0.0, "between both");
        assert!((next(0.0, -0.5) + 0.1275).abs() < 1e-6, "tension, with the closing part");
        assert_eq!(next(0.5, -10.0), -1.0, "the limit");
        assert_eq!(Limits::of(0.0).next(-0.5, -2.0, 0.5, 2.0), 0.0, "of a particle that came to the surface");
    }

    #[test]
    fn a_short_step_removes_less_of_a_large_excess() {
        assert!((most_removed(0.001, 1.0) - 0.052).abs() < 1e-6);
        assert!((most_removed(0.001, 0.2) - 0.004).abs() < 1e-6);
        assert_eq!(most_removed(0.0001, 0.0), 0.002);
        assert_eq!(most_removed(0.01, 0.0), 0.02, "the mean residual must see it");
    }

    #[test]
    fn a_pressure_outside_its_range_is_an_error() {
        let limits = Limits::of(0.0);
        assert_eq!(limits.error(-0.5, 0.01, 2.0), 1.0);
        assert_eq!(limits.error(0.0, -0.01, 2.0), 0.0);
        assert_eq!(Limits::inside(1.0, 0.1, 0.0).error(-0.5, -0.01, 2.0), 0.01);
    }
}
