//! The cubic spline as the surface needs it: without its factor.
//!
//! Monaghan's cubic spline with support radius H is `W(r) = 16 / (pi H^3) * f(r / H)` with
//! `f(q) = (1 - q)^3 - 4 (1/2 - q)^3`, where a power of a negative number counts as zero: both pieces of the usual
//! form in one, without a branch. The colour field divides one sum of W by another, so the factor cancels and is left
//! out.

/// `f(q)` for `q >= 0`.
#[inline(always)]
pub(crate) fn spline(q: f32) -> f32 {
    let a = positive(1.0 - q);
    let b = positive(0.5 - q);
    a * a * a - 4.0 * (b * b * b)
}

/// The number, or zero. `f32::max` would also treat NaN, which costs an instruction per lane.
#[inline(always)]
pub(crate) fn positive(x: f32) -> f32 {
    if x > 0.0 { x } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::spline;

    /// The formula as physicists write it, normalised: 8/(pi H^3) {6q^3 - 6q^2 + 1, 2(1 - q)^3}.
    fn textbook(q: f64) -> f64 {
        let shape = match q {
            q if q <= 0.5 => 6.0 * q.powi(3) - 6.0 * q * q + 1.0,
            q if q <= 1.0 => 2.0 * (1.0 - q).powi(3),
            _ => 0.0,
        };
        8.0 / std::f64::consts::PI * shape
    }

    #[test]
    fn it_is_the_textbook_spline_times_a_factor() {
        for i in 0..=300 {
            let q = f64::from(i) / 200.0;
            let ours = 16.0 / std::f64::consts::PI * f64::from(spline(q as f32));
            // Rounding of sums of order one in f32; the factor is 5.
            assert!((ours - textbook(q)).abs() < 1e-6, "q = {q}: {ours} against {}", textbook(q));
        }
        // The smallest change worth catching: another coefficient.
        assert!((textbook(0.3) - 5.0 * f64::from(spline(0.3))).abs() > 1e-3);
    }

    #[test]
    fn its_integral_over_space_is_one() {
        let steps = 20_000;
        let width = 1.0 / f64::from(steps);
        let shell = |i| {
            let q = (f64::from(i) + 0.5) * width;
            4.0 * std::f64::consts::PI * q * q * 16.0 / std::f64::consts::PI
                * f64::from(spline(q as f32))
                * width
        };
        let integral: f64 = (0..steps).map(shell).sum();
        assert!((integral - 1.0).abs() < 1e-5, "{integral}");
    }
}
