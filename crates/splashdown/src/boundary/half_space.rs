//! Half-spaces: the kernel's integrals over a solid behind a plane, from which bodies are built.
//!
//! A solid that fills the half-space behind a plane at distance d = qH fills the part D(q) of the kernel's integral, and
//! its gradient is G = -(A(q)/H) n with A = -D'. Both have closed forms.

use crate::kernel::{BLEND_SHARE, CubicSpline, Kernel, Poly6, Spiky, WendlandBlend, WendlandC2};
use crate::state::Params;

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

    /// The kernel of the density times H^3 but for a factor, in double precision, at q in [0, 1].
    fn exact_density(self, q: f64) -> f64 {
        let t = 1.0 - q;
        let c2 = 10.5 * t.powi(4) * (1.0 + 4.0 * q);
        match self {
            Self::WendlandC2 => c2,
            Self::WendlandBlend => WendlandBlend::exact(q)[0],
            Self::CubicSpline if q <= 0.5 => 6.0 * q * q * (q - 1.0) + 1.0,
            Self::CubicSpline => 2.0 * t.powi(3),
            Self::Mueller => (1.0 - q * q).powi(3),
        }
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

/// The part D(q) of a kernel that a plane wall fills at the distance d, with q = (stretch d + offset) / H, and the kernel for
/// which this holds.
///
/// The part D of a kernel W has D'' = 2 pi q W(q), so the kernel for which the part at the distance r is D(q) with the q above is
/// W(q) q H / r, but for a factor. The part that a body of any shape fills is the integral of this kernel over the body: inner
/// edges and corners then fit the relation for planes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaneFraction {
    /// The kernels of the fluid.
    pub kernels: KernelPair,
    /// Factor of the distance.
    pub stretch: f32,
    /// Offset of the distance in m.
    pub offset: f32,
}

impl PlaneFraction {
    /// The fluid's own kernel.
    pub fn of(kernels: KernelPair) -> Self {
        Self { kernels, stretch: 1.0, offset: 0.0 }
    }

    /// The part of the kernel that a plane at this distance fills; negative distances are behind the plane. In m.
    pub fn at(self, distance: f32, support: f32) -> f32 {
        let q = (self.stretch * distance + self.offset) / support;
        let d = if q.abs() < 1.0 { self.kernels.gradient(q.abs()).0 } else { 0.0 };
        if q < 0.0 { 1.0 - d } else { d }
    }

    /// The distance in m of the plane that fills this part.
    pub fn distance(self, part: f32, support: f32) -> f32 {
        // D is accurate for small values but 1 - D loses digits, so parts above one half use the complement.
        let (small, sign) = if part > 0.5 { (1.0 - part, -1.0) } else { (part, 1.0) };
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..30 {
            let middle = 0.5 * (low + high);
            if self.kernels.gradient(middle).0 > small { low = middle } else { high = middle }
        }
        (sign * support * 0.5 * (low + high) - self.offset) / self.stretch
    }

    /// The kernel at this distance from its centre in m, but for a factor.
    pub fn weight(self, r: f32, support: f32) -> f32 {
        let q = (self.stretch * r + self.offset) / support;
        if q > 0.0 && q < 1.0 { self.kernels.w_gradient(q) * q * support / r } else { 0.0 }
    }
}

/// The distance of the plane wall whose integrals stand for the lattice of particles that would fill a body. At a distance d
/// from the body it is e = d, plus the part of d beyond [`Params::stretched_from`] times `stretch - 1`. The density is that of D at
/// e + `offset`, and its gradient that of A at e + `slope_offset` times the derivative of e.
///
/// The integrals assume a continuum, which a lattice is not. At half a spacing and with Wendland C2 within two spacings, the
/// body fills 5 % more of the density than a lattice, and the gradient is that of a lattice within 3 %.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolidDistance {
    /// Factor of the distance beyond [`Params::stretched_from`].
    pub stretch: f32,
    /// Offset of the distance for the density, in spacings.
    pub offset: f32,
    /// Offset of the distance for the gradient, in spacings.
    pub slope_offset: f32,
}

impl SolidDistance {
    /// The part of a body's density that [`of_lattice`](Self::of_lattice) leaves out, 1 % of the rest density with a support of
    /// two spacings. A layer that is sealed between bodies and walls can otherwise not reach the rest density: where they
    /// meet, the quadrature of a map is off by 1 %, and disorder raises the sum of the kernel.
    const MARGIN: f32 = 1.0 / 14.0;

    /// The offset gives the lattice half a spacing from a plane the rest density. The offset of the gradient is zero, because
    /// with the other one the gradient would be 16 % too small. The gradient is then not the derivative of the density.
    pub fn of_density(kernels: KernelPair, support_ratio: f32) -> Self {
        let [missing, _] = half_lattice_sums(kernels, support_ratio, 0.5);
        let offset = q_of_density(kernels, missing) * support_ratio - 0.5;
        Self { stretch: 1.0, offset, slope_offset: 0.0 }
    }

    /// The gradient is that of a lattice half a spacing and one and a half spacings from a plane, and the density is that at half a
    /// spacing. `lattice_sum` is the density of the whole lattice, over the rest density. Two layers at rest then have the
    /// pressure of the fluid behind them: with [`of_density`](Self::of_density) the body pushes the second layer by 22 % too much
    /// at a support of three spacings, which lowers the pressure of the first by a tenth.
    pub fn of_layers(kernels: KernelPair, support_ratio: f32, lattice_sum: f32) -> Self {
        let [missing, near] = half_lattice_sums(kernels, support_ratio, 0.5).map(|sum| lattice_sum * sum);
        let [_, far] = half_lattice_sums(kernels, support_ratio, 1.5).map(|sum| lattice_sum * sum);
        // The derivative of the distance multiplies the gradient, so that the distances depend on the stretch.
        let distance = |gradient: f32| support_ratio * q_where(|q| kernels.density(q).1 > gradient);
        let (mut low, mut high) = (0.5, 2.0);
        for _ in 0..40 {
            let stretch = 0.5 * (low + high);
            let between = distance(far / stretch) - distance(near / stretch);
            if between > stretch { low = stretch } else { high = stretch }
        }
        let stretch = 0.5 * (low + high);
        let stretched = 0.5 + (stretch - 1.0) * (0.5 - Params::STRETCHED_FROM);
        Self {
            stretch,
            offset: q_of_density(kernels, missing) * support_ratio - stretched,
            slope_offset: distance(near / stretch) - stretched,
        }
    }

    /// The density, but for a margin, is that of a lattice half a spacing from a plane. The gradient is the derivative of the
    /// density, and that of the lattice but for up to 5 %, by which the margin reduces it. `dfsph` determines its pressures
    /// from the density: with another gradient the forces of a body are not those of a potential, and they drive currents.
    /// This applies to a body alone. Where images or a second body limit its part, the gradient is approximate.
    pub fn of_lattice(kernels: KernelPair, support_ratio: f32) -> Self {
        let [missing, gradient] = half_lattice_sums(kernels, support_ratio, 0.5);
        let q = q_of_density(kernels, missing);
        let steepness = kernels.density(q).1;
        let stretch = gradient / steepness;
        let offset = (q + Self::MARGIN * missing / steepness) * support_ratio - 0.5 * stretch;
        Self { stretch, offset, slope_offset: offset }
    }
}

/// The part of a lattice's density, and of H times its gradient, that comes from the points behind a plane at this distance in
/// spacings, the first of which are half a spacing behind it.
fn half_lattice_sums(kernels: KernelPair, support_ratio: f32, distance: f64) -> [f32; 2] {
    const STEP: f64 = 1e-4;
    let ratio = f64::from(support_ratio);
    let sum = |shift: f64| {
        let (mut whole, mut behind) = (0.0, 0.0);
        for (x, y, z) in cube(support_ratio.ceil() as i32) {
            let square = |x: f64| x * x + f64::from(y * y + z * z);
            let w = |x: f64| {
                let q = square(x).sqrt() / ratio;
                if q < 1.0 { kernels.exact_density(q) } else { 0.0 }
            };
            whole += w(f64::from(x));
            behind += if f64::from(x) + distance < 0.0 { w(f64::from(x) + shift) } else { 0.0 };
        }
        behind / whole
    };
    [sum(0.0) as f32, (ratio * (sum(STEP) - sum(-STEP)) / (2.0 * STEP)) as f32]
}

/// The q at which a plane wall fills this part of the density.
fn q_of_density(kernels: KernelPair, part: f32) -> f32 {
    q_where(|q| kernels.density(q).0 > part)
}

/// The q in [0, 1] at which a condition ends to hold.
fn q_where(holds: impl Fn(f32) -> bool) -> f32 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if holds(middle) { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// The integer points of a cube.
fn cube(reach: i32) -> impl Iterator<Item = (i32, i32, i32)> {
    let side = move || -reach..=reach;
    side().flat_map(move |x| side().flat_map(move |y| side().map(move |z| (x, y, z))))
}

#[cfg(test)]
mod tests;
