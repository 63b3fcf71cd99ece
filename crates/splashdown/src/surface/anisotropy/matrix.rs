//! Symmetric matrices, as their elements xx, xy, xz, yy, yz, zz. The same formulas as in `shapes.wgsl`.

/// The square.
#[inline(always)]
pub(super) fn squared([xx, xy, xz, yy, yz, zz]: [f32; 6]) -> [f32; 6] {
    [
        xx * xx + xy * xy + xz * xz,
        xx * xy + xy * yy + xz * yz,
        xx * xz + xy * yz + xz * zz,
        xy * xy + yy * yy + yz * yz,
        xy * xz + yy * yz + yz * zz,
        xz * xz + yz * yz + zz * zz,
    ]
}

/// The inverse.
#[inline(always)]
pub(super) fn inverted([xx, xy, xz, yy, yz, zz]: [f32; 6]) -> [f32; 6] {
    let [a, b, c] = [yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy];
    let inverse = 1.0 / determinant([xx, xy, xz, yy, yz, zz]);
    [a, b, c, xx * zz - xz * xz, xy * xz - xx * yz, xx * yy - xy * xy].map(|element| inverse * element)
}

/// The determinant.
#[inline(always)]
pub(super) fn determinant([xx, xy, xz, yy, yz, zz]: [f32; 6]) -> f32 {
    xx * (yy * zz - yz * yz) + xy * (xz * yz - xy * zz) + xz * (xy * yz - xz * yy)
}

/// Adds a multiple of the unit matrix.
#[inline(always)]
pub(super) fn plus([xx, xy, xz, yy, yz, zz]: [f32; 6], unit: f32) -> [f32; 6] {
    [xx + unit, xy, xz, yy + unit, yz, zz + unit]
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{Mat3, Vec3};

    const M: [f32; 6] = [2.0, -0.3, 0.4, 1.5, 0.2, 0.7];

    fn full([xx, xy, xz, yy, yz, zz]: [f32; 6]) -> Mat3 {
        Mat3::from_cols(Vec3::new(xx, xy, xz), Vec3::new(xy, yy, yz), Vec3::new(xz, yz, zz))
    }

    #[test]
    fn squares_and_inverses_are_those_of_the_full_matrix() {
        assert!(full(squared(M)).abs_diff_eq(full(M) * full(M), 1e-6));
        assert!((full(inverted(M)) * full(M)).abs_diff_eq(Mat3::IDENTITY, 1e-6));
        assert!((determinant(M) - full(M).determinant()).abs() < 1e-6);
        assert!(full(plus(M, 3.0)).abs_diff_eq(full(M) + 3.0 * Mat3::IDENTITY, 1e-6));
        // Control: elements in another order are another matrix.
        let [xx, xy, xz, yy, yz, zz] = M;
        assert!(!full(squared([xx, xy, xz, yz, yy, zz])).abs_diff_eq(full(M) * full(M), 0.1));
    }
}
