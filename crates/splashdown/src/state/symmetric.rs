//! Symmetric matrices.

use glam::{Vec3, Vec4, Vec4Swizzles};
use splashdown_gpu::WgslModule;

/// The WGSL side.
pub const WGSL: WgslModule = WgslModule { name: "sph/symmetric", source: include_str!("symmetric.wgsl") };

/// A symmetric matrix.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Symmetric {
    /// The elements xx, yy, zz.
    pub diagonal: Vec3,
    /// The elements xy, xz, yz.
    pub others: Vec3,
}

impl Symmetric {
    /// The matrix in the first three components of two vectors.
    #[inline(always)]
    pub fn from_vectors([a, b]: [Vec4; 2]) -> Self {
        Self { diagonal: a.xyz(), others: b.xyz() }
    }

    /// The elements xx, yy, zz, xy, xz, yz.
    #[inline(always)]
    pub fn to_array(self) -> [f32; 6] {
        let ([a, b, c], [d, e, f]) = (self.diagonal.to_array(), self.others.to_array());
        [a, b, c, d, e, f]
    }

    /// The sum of two matrices.
    #[inline(always)]
    pub fn plus(self, other: Self) -> Self {
        Self { diagonal: self.diagonal + other.diagonal, others: self.others + other.others }
    }

    /// The product with a number.
    #[inline(always)]
    pub fn times(self, factor: f32) -> Self {
        Self { diagonal: factor * self.diagonal, others: factor * self.others }
    }

    /// The unit matrix minus this matrix over its trace: for a multiple of n (x) n, the projection onto the plane with
    /// the normal n.
    #[inline(always)]
    pub fn rest_of_unit(self) -> Self {
        let part = self.times(-1.0 / self.diagonal.element_sum().max(1e-20));
        Self { diagonal: part.diagonal + 1.0, ..part }
    }

    /// The sum of the products of all elements.
    #[inline(always)]
    pub fn contract(self, other: Self) -> f32 {
        self.diagonal.dot(other.diagonal) + 2.0 * self.others.dot(other.others)
    }

    /// v.(M v).
    #[inline(always)]
    pub fn along(self, v: Vec3) -> f32 {
        self.contract(Self { diagonal: v * v, others: Vec3::new(v.x * v.y, v.x * v.z, v.y * v.z) })
    }

    /// The adjugate, which is the inverse times the determinant, and the determinant.
    #[inline(always)]
    pub fn adjugate(self) -> (Self, f32) {
        let ([xx, yy, zz], [xy, xz, yz]) = (self.diagonal.to_array(), self.others.to_array());
        let diagonal = Vec3::new(yy * zz - yz * yz, xx * zz - xz * xz, xx * yy - xy * xy);
        let others = Vec3::new(xz * yz - xy * zz, xy * yz - xz * yy, xy * xz - yz * xx);
        (Self { diagonal, others }, xx * diagonal.x + xy * others.x + xz * others.y)
    }
}
