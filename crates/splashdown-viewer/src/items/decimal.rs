//! Numbers with few decimals.
//!
//! A sum such as 0.1 + 0.26 in single precision is 0.35999998, and a scene file contains every digit that it needs. What is
//! changed in the window is therefore rounded to decimals that are much finer than the particles.

use glam::Vec3;

/// The number rounded to a power of ten, between a thousandth and a ten-thousandth of `scale`. A number without such a
/// rounding remains.
pub fn decimal(x: f32, scale: f32) -> f32 {
    let digits = 3_i32.saturating_sub(f64::from(scale).log10().floor() as i32);
    // A division, because negative powers of ten are not exact.
    let rounded = match digits {
        0.. => (f64::from(x) * 10_f64.powi(digits)).round() / 10_f64.powi(digits),
        _ => {
            (f64::from(x) / 10_f64.powi(digits.saturating_neg())).round()
                * 10_f64.powi(digits.saturating_neg())
        }
    } as f32;
    // Adding zero turns -0 into 0.
    if rounded.is_finite() { rounded + 0.0 } else { x }
}

/// The vector with rounded components.
pub fn decimals(v: Vec3, scale: f32) -> Vec3 {
    Vec3::from_array(v.to_array().map(|x| decimal(x, scale)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_have_few_decimals() {
        let sum = 0.1_f32 + 0.26;
        let places = [(1.2_f32 + 0.36) - 1.2, 0.7 - 0.34, sum];
        // Control: without rounding at least one of them has nine digits.
        assert!(places.iter().any(|x| x.to_string().len() > 6), "{places:?}");
        for x in places {
            assert_eq!(decimal(x, 0.02).to_string(), "0.36");
        }
        assert_eq!(decimal(-1e-9, 0.02).to_string(), "0");
        assert_eq!(decimal(123_456.0, 2e6), 123_000.0);
        assert_eq!(decimal(0.123_456_7, 0.02), 0.123_46);
    }

    #[test]
    fn the_error_is_far_below_the_scale() {
        for scale in [1e-4_f32, 0.003, 0.02, 0.999, 1.0, 50.0] {
            for step in 0..100_u8 {
                let x = 0.01 * scale * f32::from(step) + scale / 3.0;
                assert!((decimal(x, scale) - x).abs() <= 6e-4 * scale, "{x} at {scale}");
            }
        }
        // What cannot be rounded remains.
        for scale in [0.0, f32::NAN, f32::INFINITY] {
            assert_eq!(decimal(0.25, scale), 0.25);
        }
        assert!(decimal(f32::NAN, 1.0).is_nan());
    }
}
