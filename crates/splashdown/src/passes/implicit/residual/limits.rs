//! The range of the implicit pressure of a particle, and its residual there (see the [module](super)).

use super::{LARGEST_HELD, LARGEST_REMOVED, LEAST_REMOVED};

/// What determines the residual of a particle, besides the change of its density in the step.
#[derive(Clone, Copy)]
pub(super) struct Limits {
    /// The smallest k, in m^2/s^2: zero, or minus the limit of the tension.
    least: f32,
    /// The excess of density that a pressure above zero takes away.
    pushed: f32,
    /// The excess of density that a pressure below zero takes away.
    pulled: f32,
}

/// The part of an excess of density that a step removes, for its length over that of the longest step; a deficit is unchanged.
#[inline(always)]
pub(super) fn removed(excess: f32, tolerance: f32, dt_ratio: f32) -> f32 {
    excess.min(LEAST_REMOVED.max(2.0 * tolerance) + LARGEST_REMOVED * dt_ratio * dt_ratio)
}

impl Limits {
    /// Of a particle that cannot be under tension.
    #[inline(always)]
    pub fn of(excess: f32) -> Self {
        Self { least: 0.0, pushed: excess, pulled: excess }
    }

    /// Of a particle inside the fluid, where this part of a deficit of density closes in the step.
    #[inline(always)]
    pub fn inside(tension_limit: f32, closing: f32, excess: f32) -> Self {
        let (pushed, pulled) = if excess < 0.0 {
            let closed = (closing * excess).max(excess);
            (closed.min(excess + LARGEST_HELD), closed)
        } else {
            (excess, excess)
        };
        Self { least: -tension_limit, pushed, pulled }
    }

    /// The residual at the pressure `k`, for the other terms of it: the change of the density in the step, less the
    /// compression.
    #[inline(always)]
    pub fn residual(&self, k: f32, change: f32) -> f32 {
        let (pushed, pulled) = (self.pushed + change, self.pulled + change);
        if k > 0.0 || k == 0.0 && pushed > 0.0 {
            pushed
        } else if k < 0.0 || pulled < 0.0 {
            pulled
        } else {
            0.0
        }
    }

    /// The pressure after `k`, for the other terms of the residual.
    #[inline(always)]
    pub fn next(&self, k: f32, change: f32, relaxation: f32, diagonal: f32) -> f32 {
        let positive = k + relaxation * (self.pushed + change) / diagonal;
        if positive > 0.0 {
            return positive;
        }
        (k + relaxation * (self.pulled + change) / diagonal).min(0.0).max(self.least)
    }

    /// The error of `k` in units of the residual: zero if the pressure would have to leave its range to make the residual
    /// smaller.
    #[inline(always)]
    pub fn error(&self, k: f32, residual: f32, diagonal: f32) -> f32 {
        if k > self.least { residual.abs() } else { residual.max(diagonal * (self.least - k)) }
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
        assert_eq!(removed(0.05, 0.001, 1.0), 0.05);
        assert!((removed(0.1, 0.001, 1.0) - 0.052).abs() < 1e-6);
        assert!((removed(0.1, 0.001, 0.2) - 0.004).abs() < 1e-6);
        assert_eq!(removed(0.002, 0.0001, 0.0), 0.002);
        assert_eq!(removed(0.02, 0.01, 0.0), 0.02, "the mean residual must see it");
        assert_eq!(removed(-0.1, 0.001, 0.2), -0.1);
    }

    #[test]
    fn a_pressure_outside_its_range_is_an_error() {
        let limits = Limits::of(0.0);
        assert_eq!(limits.error(-0.5, 0.01, 2.0), 1.0);
        assert_eq!(limits.error(0.0, -0.01, 2.0), 0.0);
        assert_eq!(Limits::inside(1.0, 0.1, 0.0).error(-0.5, -0.01, 2.0), 0.01);
    }
}
