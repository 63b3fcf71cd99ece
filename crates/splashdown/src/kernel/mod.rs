//! Smoothing kernels in three dimensions, the same formulas as in `kernel.wgsl`.
//!
//! All are written over q = r / H, with H the support radius, so that the functions here are free of units:
//! W = [`Kernel::w`] / H^3 and grad W = [`Kernel::g`] / H^5 * (x_i - x_j). Both are zero for q >= 1 and finite at q = 0
//! (except where a formula says otherwise).

use std::f32::consts::PI;

use splashdown_gpu::WgslModule;

use crate::simd::Lanes;

/// The WGSL implementation: `kernel_w` and `kernel_g`, selected by `override KERNEL`.
pub const WGSL: WgslModule = WgslModule { name: "sph/kernel", source: include_str!("kernel.wgsl") };

/// A kernel for the loops on the CPU: arithmetic without branches, on one number or a register of numbers.
/// Implementations must be `#[inline(always)]`.
pub trait Kernel: Copy + Send + Sync + 'static {
    /// The value of WGSL's `KERNEL` that selects it.
    const ID: u32;
    /// W * H^3.
    fn w<V: Lanes>(q: V) -> V;
    /// The factor g in grad W = g / H^5 * (x_i - x_j).
    fn g<V: Lanes>(q: V) -> V;
}

/// 1 - q, clamped to zero beyond the support.
#[inline(always)]
fn inside<V: Lanes>(q: V) -> V {
    (V::splat(1.0) - q).max(V::splat(0.0))
}

/// Wendland C2 (Wendland 1995; Dehnen & Aly 2012): no pairing instability, and a gradient without division by r.
#[derive(Clone, Copy, Debug)]
pub struct WendlandC2;

impl Kernel for WendlandC2 {
    const ID: u32 = 0;

    #[inline(always)]
    fn w<V: Lanes>(q: V) -> V {
        let t = inside(q);
        let t2 = t * t;
        t2 * t2 * (q * 4.0 + 1.0) * (21.0 / (2.0 * PI))
    }

    #[inline(always)]
    fn g<V: Lanes>(q: V) -> V {
        let t = inside(q);
        t * t * t * (-210.0 / PI)
    }
}

/// A blend of the C2 functions of Wendland (1995) for three dimensions and for one.
///
/// A cubic lattice with this kernel and a support of two spacings does not resist a stretch along an axis: the density that is
/// summed stays the same to second order (see [`BLEND_SHARE`]). With the function for three dimensions alone the summed
/// density rises, and the pressure that results resists the shear of a wave, whose period is then an eighth too short. The
/// Fourier transform of the blend is positive for wavelengths above a fifth of a spacing, so that particles do not form pairs.
#[derive(Clone, Copy, Debug)]
pub struct WendlandBlend;

/// The part of the function for one dimension in [`WendlandBlend`], rounded down from 0.357. With that part a cubic lattice with
/// a support of two spacings offers no resistance to a stretch along an axis; with a larger one the lattice is unstable.
pub const BLEND_SHARE: f32 = 0.35;

impl WendlandBlend {
    /// W H^3 and -q dW/dq H^3 in double precision, for sums over a lattice. q must be below one.
    pub(crate) fn exact(q: f64) -> [f64; 2] {
        use std::f64::consts::PI;
        let (one, t) = (f64::from(BLEND_SHARE), 1.0 - q);
        let three = 1.0 - one;
        let w = three * 10.5 * t * (1.0 + 4.0 * q) + one * 6.5625 * (1.0 + 3.0 * q);
        let g = three * 210.0 * t + one * 78.75;
        [w * t.powi(3) / PI, g * (q * t).powi(2) / PI]
    }
}

impl Kernel for WendlandBlend {
    const ID: u32 = 4;

    #[inline(always)]
    fn w<V: Lanes>(q: V) -> V {
        const THREE: f32 = (1.0 - BLEND_SHARE) * 21.0 / (2.0 * PI);
        const ONE: f32 = BLEND_SHARE * 105.0 / (16.0 * PI);
        let t = inside(q);
        t * t * t * (t * (q * (4.0 * THREE) + THREE) + (q * (3.0 * ONE) + ONE))
    }

    #[inline(always)]
    fn g<V: Lanes>(q: V) -> V {
        const THREE: f32 = (1.0 - BLEND_SHARE) * 210.0 / PI;
        const ONE: f32 = BLEND_SHARE * 315.0 / (4.0 * PI);
        let t = inside(q);
        t * t * (t * -THREE - ONE)
    }
}

/// The cubic spline (Monaghan & Lattanzio 1985).
#[derive(Clone, Copy, Debug)]
pub struct CubicSpline;

impl Kernel for CubicSpline {
    const ID: u32 = 1;

    #[inline(always)]
    fn w<V: Lanes>(q: V) -> V {
        let t = inside(q);
        let near = q * q * (q - 1.0) * 6.0 + 1.0;
        let far = t * t * t * 2.0;
        q.if_less(V::splat(0.5), near, far) * (8.0 / PI)
    }

    #[inline(always)]
    fn g<V: Lanes>(q: V) -> V {
        let (t, half) = (inside(q), V::splat(0.5));
        let near = q * 3.0 - 2.0;
        let far = t * t * -1.0 / q.max(half);
        q.if_less(half, near, far) * (48.0 / PI)
    }
}

/// The poly6 kernel of Mueller, Charypar & Gross 2003, for the density and the colour field.
#[derive(Clone, Copy, Debug)]
pub struct Poly6;

impl Kernel for Poly6 {
    const ID: u32 = 2;

    #[inline(always)]
    fn w<V: Lanes>(q: V) -> V {
        let t = inside(q * q);
        t * t * t * (315.0 / (64.0 * PI))
    }

    #[inline(always)]
    fn g<V: Lanes>(q: V) -> V {
        let t = inside(q * q);
        t * t * (-945.0 / (32.0 * PI))
    }
}

impl Poly6 {
    /// The Laplacian of W times H^5.
    #[inline(always)]
    pub fn laplacian<V: Lanes>(q: V) -> V {
        inside(q * q) * (V::splat(3.0) - q * q * 7.0) * (-945.0 / (32.0 * PI))
    }
}

/// Lower bound of q in divisions. Below it the direction is undefined, and the product with x_i - x_j is
/// negligible.
pub const SMALLEST_Q: f32 = 1e-4;

/// The spiky kernel of the same paper, for the pressure: its gradient does not vanish at the centre.
#[derive(Clone, Copy, Debug)]
pub struct Spiky;

impl Kernel for Spiky {
    const ID: u32 = 3;

    #[inline(always)]
    fn w<V: Lanes>(q: V) -> V {
        let t = inside(q);
        t * t * t * (15.0 / PI)
    }

    #[inline(always)]
    fn g<V: Lanes>(q: V) -> V {
        let t = inside(q);
        t * t * (-45.0 / PI) / q.max(V::splat(SMALLEST_Q))
    }
}

/// The Laplacian, times H^5, of the viscosity kernel of the same paper. It is positive everywhere, so
/// viscosity never increases the kinetic energy.
#[inline(always)]
pub fn viscosity_laplacian<V: Lanes>(q: V) -> V {
    inside(q) * (45.0 / PI)
}

#[cfg(test)]
mod tests;
