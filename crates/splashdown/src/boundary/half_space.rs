//! Half-spaces: the kernel's integrals over a solid behind a plane, from which bodies are built.
//!
//! A solid that fills the half-space behind a plane at distance d = qH fills the part D(q) of the kernel's integral, and
//! its gradient is G = -(A(q)/H) n with A = -D'. Both have closed forms.

use crate::kernel::{BLEND_SHARE, CubicSpline, Kernel, Poly6, Spiky, WendlandBlend, WendlandC2};

/// The kernels of the density and of the pressure gradient.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KernelPair {
    /// Wendland C2 for both.
    WendlandC2,
    /// The blend of Wendland's functions for both.
    WendlandBlend,
    /// The cubic spline for both.
    CubicSpline,
    /// Poly6 for the density, spiky for the pressure.
    Mueller,
}

impl KernelPair {
    /// The value of WGSL's `WALL_KERNEL` that selects it.
    pub const fn id(self) -> u32 {
        match self {
            Self::WendlandC2 => 0,
            Self::CubicSpline => 1,
            Self::Mueller => 2,
            Self::WendlandBlend => 3,
        }
    }

    /// D and A of the kernel for the density at q in [0, 1].
    #[inline]
    pub fn density(self, q: f32) -> (f32, f32) {
        match self {
            Self::WendlandC2 => wendland_c2(q),
            Self::WendlandBlend => wendland_blend(q),
            Self::CubicSpline => cubic_spline(q),
            Self::Mueller => poly6(q),
        }
    }

    /// D and A of the kernel for the gradient at q in [0, 1].
    #[inline]
    pub fn gradient(self, q: f32) -> (f32, f32) {
        match self {
            Self::Mueller => spiky(q),
            same => same.density(q),
        }
    }

    /// The kernel of the density times H^3, at q in [0, 1].
    pub fn w(self, q: f32) -> f32 {
        self.both(f64::from(q))[0] as f32
    }

    /// The kernel of the gradient times H^3, at q in [0, 1].
    pub fn w_gradient(self, q: f32) -> f32 {
        self.both(f64::from(q))[1] as f32
    }

    fn both(self, q: f64) -> [f64; 2] {
        let q = q as f32;
        let [density, gradient] = match self {
            Self::WendlandC2 => [WendlandC2::w(q); 2],
            Self::WendlandBlend => [WendlandBlend::w(q); 2],
            Self::CubicSpline => [CubicSpline::w(q); 2],
            Self::Mueller => [Poly6::w(q), Spiky::w(q)],
        };
        [f64::from(density), f64::from(gradient)]
    }
}

/// A kernel of the density whose integrals over half-spaces are implemented.
pub trait WallKernel {
    /// The kernels of the walls.
    const WALLS: KernelPair;
}
impl WallKernel for WendlandC2 {
    const WALLS: KernelPair = KernelPair::WendlandC2;
}
impl WallKernel for WendlandBlend {
    const WALLS: KernelPair = KernelPair::WendlandBlend;
}
impl WallKernel for CubicSpline {
    const WALLS: KernelPair = KernelPair::CubicSpline;
}
impl WallKernel for Poly6 {
    const WALLS: KernelPair = KernelPair::Mueller;
}

fn wendland_c2(q: f32) -> (f32, f32) {
    let t = 1.0 - q;
    let t5 = t * t * t * t * t;
    (0.5 * t5 * t * (3.0 * q * q + 3.0 * q + 1.0), 1.5 * t5 * (8.0 * q * q + 5.0 * q + 1.0))
}

fn wendland_blend(q: f32) -> (f32, f32) {
    const THREE: f32 = 1.0 - BLEND_SHARE;
    let t = 1.0 - q;
    let t4 = t * t * t * t;
    let d = 0.5 * t * (1.0 + q * (3.0 + 3.0 * q)) * THREE + (2.625 + t * (0.9375 * t - 3.0625)) * BLEND_SHARE;
    let a =
        1.5 * t * (1.0 + q * (5.0 + 8.0 * q)) * THREE + (13.125 + t * (6.5625 * t - 18.375)) * BLEND_SHARE;
    (t4 * t * d, t4 * a)
}

fn cubic_spline(q: f32) -> (f32, f32) {
    if q >= 0.5 {
        let t = 1.0 - q;
        let t4 = t * t * t * t;
        return (8.0 / 15.0 * t4 * t * (2.0 * q + 1.0), 1.6 * t4 * (4.0 * q + 1.0));
    }
    let q2 = q * q;
    let d = 0.5 - 1.4 * q + q2 * q * (8.0 / 3.0 + q2 * (-24.0 / 5.0 + 16.0 / 5.0 * q));
    (d, 1.4 + q2 * (-8.0 + q2 * (24.0 - 96.0 / 5.0 * q)))
}

fn poly6(q: f32) -> (f32, f32) {
    // Expressed in t = 1 - q, so that D stays positive near q = 1.
    let (t, s) = (1.0 - q, 1.0 - q * q);
    let inner = 16.0 / 5.0 + t * (-16.0 / 3.0 + t * (24.0 / 7.0 + t * (t / 9.0 - 1.0)));
    (315.0 / 256.0 * t * t * t * t * t * inner, 315.0 / 256.0 * s * s * s * s)
}

fn spiky(q: f32) -> (f32, f32) {
    let t = 1.0 - q;
    let t4 = t * t * t * t;
    (t4 * t * (1.5 - t), 1.5 * t4 * (1.0 + 4.0 * q))
}

/// The distance in spacings between the surface of a body and the solid behind it, for the density only. With this offset
/// a lattice half a spacing from a plane surface has exactly the rest density.
///
/// The integral assumes a continuum, which a lattice is not. Without the offset the first layer is 5 % too dense
/// (Wendland C2, two spacings of support). The offset solves D((spacing/2 + offset)/H) = 1 - (lattice sum of the
/// half-space). The gradient of the lattice agrees with the integral without the offset (within 3 %; with the offset it
/// would be 16 % too weak), so slopes do not use it.
pub fn solid_offset(kernels: KernelPair, support_ratio: f32) -> f32 {
    let ratio = f64::from(support_ratio);
    let (mut whole, mut behind) = (0.0, 0.0);
    for (x, y, z) in cube(support_ratio.ceil() as i32) {
        let q = f64::from(x * x + y * y + z * z).sqrt() / ratio;
        if q < 1.0 {
            let [w, _] = kernels.both(q);
            whole += w;
            behind += if x < 0 { w } else { 0.0 };
        }
    }
    let missing = (behind / whole) as f32;
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if kernels.density(middle).0 > missing { low = middle } else { high = middle }
    }
    low * support_ratio - 0.5
}

/// The integer points of a cube.
fn cube(reach: i32) -> impl Iterator<Item = (i32, i32, i32)> {
    let side = move || -reach..=reach;
    side().flat_map(move |x| side().flat_map(move |y| side().map(move |z| (x, y, z))))
}

#[cfg(test)]
mod tests;
