//! Smoothing kernels in three dimensions, the same formulas as in `kernel.wgsl`.
//!
//! All are written over q = r / H, with H the support radius, so that the functions here are free of units:
//! W = [`Kernel::w`] / H^3 and grad W = [`Kernel::g`] / H^5 * (x_i - x_j). Both are zero for q >= 1 and finite at q = 0
//! (except where a formula says otherwise).

use std::f32::consts::PI;

use splashdown_gpu::WgslModule;

/// The WGSL side: `kernel_w`, `kernel_g`, chosen by `override KERNEL`.
pub const WGSL: WgslModule = WgslModule { name: "sph/kernel", source: include_str!("kernel.wgsl") };

/// A kernel as the CPU's loops see it: plain arithmetic without branches, so that it vectorises.
pub trait Kernel: Copy + Send + Sync + 'static {
    /// The number by which WGSL's `KERNEL` chooses it.
    const ID: u32;
    /// W * H^3.
    fn w(q: f32) -> f32;
    /// The factor g with grad W = g / H^5 * (x_i - x_j).
    fn g(q: f32) -> f32;
}

/// Larger of two numbers, as one instruction; the second one if the first is NaN.
#[inline(always)]
pub fn max(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// Wendland C2 (Wendland 1995; Dehnen & Aly 2012): no pairing instability, and a gradient without division by r.
#[derive(Clone, Copy, Debug)]
pub struct WendlandC2;

impl Kernel for WendlandC2 {
    const ID: u32 = 0;

    #[inline(always)]
    fn w(q: f32) -> f32 {
        let t = max(1.0 - q, 0.0);
        let t2 = t * t;
        21.0 / (2.0 * PI) * t2 * t2 * (1.0 + 4.0 * q)
    }

    #[inline(always)]
    fn g(q: f32) -> f32 {
        let t = max(1.0 - q, 0.0);
        -210.0 / PI * t * t * t
    }
}

/// The cubic spline (Monaghan & Lattanzio 1985).
#[derive(Clone, Copy, Debug)]
pub struct CubicSpline;

impl Kernel for CubicSpline {
    const ID: u32 = 1;

    #[inline(always)]
    fn w(q: f32) -> f32 {
        let t = max(1.0 - q, 0.0);
        let near = 6.0 * q * q * (q - 1.0) + 1.0;
        let far = 2.0 * t * t * t;
        8.0 / PI * if q <= 0.5 { near } else { far }
    }

    #[inline(always)]
    fn g(q: f32) -> f32 {
        let t = max(1.0 - q, 0.0);
        let near = 3.0 * q - 2.0;
        let far = -t * t / max(q, 0.5);
        48.0 / PI * if q <= 0.5 { near } else { far }
    }
}

/// The poly6 kernel of Mueller, Charypar & Gross 2003, for the density and the colour field.
#[derive(Clone, Copy, Debug)]
pub struct Poly6;

impl Kernel for Poly6 {
    const ID: u32 = 2;

    #[inline(always)]
    fn w(q: f32) -> f32 {
        let t = max(1.0 - q * q, 0.0);
        315.0 / (64.0 * PI) * t * t * t
    }

    #[inline(always)]
    fn g(q: f32) -> f32 {
        let t = max(1.0 - q * q, 0.0);
        -945.0 / (32.0 * PI) * t * t
    }
}

impl Poly6 {
    /// The Laplacian of W times H^5.
    #[inline(always)]
    pub fn laplacian(q: f32) -> f32 {
        let t = max(1.0 - q * q, 0.0);
        -945.0 / (32.0 * PI) * t * (3.0 - 7.0 * q * q)
    }
}

/// The smallest q that divides: below it a direction has no meaning, and the product with x_i - x_j vanishes.
pub const SMALLEST_Q: f32 = 1e-4;

/// The spiky kernel of the same paper, for the pressure: its gradient does not vanish at the centre.
#[derive(Clone, Copy, Debug)]
pub struct Spiky;

impl Kernel for Spiky {
    const ID: u32 = 3;

    #[inline(always)]
    fn w(q: f32) -> f32 {
        let t = max(1.0 - q, 0.0);
        15.0 / PI * t * t * t
    }

    #[inline(always)]
    fn g(q: f32) -> f32 {
        let t = max(1.0 - q, 0.0);
        -45.0 / PI * t * t / max(q, SMALLEST_Q)
    }
}

/// The Laplacian, times H^5, of the viscosity kernel of the same paper: positive everywhere, so friction never heats.
#[inline(always)]
pub fn viscosity_laplacian(q: f32) -> f32 {
    45.0 / PI * max(1.0 - q, 0.0)
}

#[cfg(test)]
mod tests;
