//! The wall integrals by quadrature, from their definition: the kernel integrated over everything behind a closed side.

use std::f64::consts::PI;

use glam::DVec3;
use splashdown::state::Params;

use super::oracle::Kernel;

/// The kernels of the density and of the gradient.
#[derive(Clone, Copy, Debug)]
pub struct Kernels {
    pub density: Kernel,
    pub gradient: Kernel,
}

/// The wall integrals at one particle.
#[derive(Clone, Debug)]
pub struct Wall {
    /// The integral of W over the solids, which start `wall_offset` behind the closed sides.
    pub density: f64,
    /// G: the gradient of the integral over solids that start at the sides, in 1/m.
    pub gradient: DVec3,
    /// The integral of the gradient's kernel over the half-space behind each single side.
    pub plane: [f64; 3],
    /// H times the magnitude of its gradient.
    pub single: [f64; 3],
    /// Direction towards the inside, per axis.
    pub normal: DVec3,
    /// The distance to the nearest closed side of each axis, if it is less than the support.
    pub distance: [Option<f64>; 3],
    /// Number of sides within the support: one is exact, edges have the interpolation error of the table, corners that of
    /// the product formula.
    pub near: usize,
}

/// Quadrature of one kernel.
struct Solid {
    /// The integral of the kernel along a line at distance rho from the centre, on an even grid of rho in [0, 1].
    line: Vec<f64>,
    kernel: Kernel,
}

const FINE: usize = 4000;

/// Gauss-Legendre with 16 points on [-1, 1]: (node, weight) of the positive half.
const GAUSS: [(f64, f64); 8] = [
    (0.095_012_509_837_637_44, 0.189_450_610_455_068_5),
    (0.281_603_550_779_258_9, 0.182_603_415_044_923_6),
    (0.458_016_777_657_227_4, 0.169_156_519_395_002_54),
    (0.617_876_244_402_643_7, 0.149_595_988_816_576_73),
    (0.755_404_408_355_003, 0.124_628_971_255_533_87),
    (0.865_631_202_387_831_7, 0.095_158_511_682_492_78),
    (0.944_575_023_073_232_6, 0.062_253_523_938_647_89),
    (0.989_400_934_991_649_9, 0.027_152_459_411_754_095),
];

fn integrate(low: f64, high: f64, f: impl Fn(f64) -> f64) -> f64 {
    if high <= low {
        return 0.0;
    }
    let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
    GAUSS.iter().map(|(x, weight)| weight * (f(middle - half * x) + f(middle + half * x))).sum::<f64>() * half
}

impl Solid {
    fn new(kernel: Kernel) -> Self {
        let along = |rho: f64| {
            let end = (1.0 - rho * rho).max(0.0).sqrt();
            let half = (0.25 - rho * rho).max(0.0).sqrt();
            let w = |z: f64| kernel.w((rho * rho + z * z).sqrt());
            // The cubic spline changes its formula at q = 1/2.
            2.0 * (integrate(0.0, half, w) + integrate(half, end, w))
        };
        Self { line: (0..=FINE).map(|i| along(i as f64 / FINE as f64)).collect(), kernel }
    }

    fn along(&self, rho: f64) -> f64 {
        if rho >= 1.0 {
            return 0.0;
        }
        let at = rho * FINE as f64;
        let (i, f) = (at as usize, at.fract());
        self.line[i] * (1.0 - f) + self.line[(i + 1).min(FINE)] * f
    }

    /// The kernel over the plane at distance q: A.
    fn plane(&self, q: f64) -> f64 {
        integrate(q, 0.5, |r| 2.0 * PI * r * self.kernel.w(r))
            + integrate(q.max(0.5), 1.0, |r| 2.0 * PI * r * self.kernel.w(r))
    }

    /// The kernel over the half-space at distance q: D.
    fn half_space(&self, q: f64) -> f64 {
        integrate(q, 0.5, |s| self.plane(s)) + integrate(q.max(0.5), 1.0, |s| self.plane(s))
    }

    /// The kernel over the half-plane at distance a that lies beyond b: minus the derivative of `edge` by a.
    fn half_plane(&self, a: f64, b: f64) -> f64 {
        let end = (1.0 - a * a).max(0.0).sqrt();
        integrate(b, end, |t| self.along((a * a + t * t).sqrt()))
    }

    /// The kernel over the quarter-space beyond a and b.
    fn edge(&self, a: f64, b: f64) -> f64 {
        integrate(a, (1.0 - b * b).max(0.0).sqrt(), |s| self.half_plane(s, b))
    }

    /// The kernel over the quarter of the plane at distance a that lies beyond b and c.
    fn quarter_plane(&self, a: f64, b: f64, c: f64) -> f64 {
        let end = (1.0 - a * a - c * c).max(0.0).sqrt();
        integrate(b, end, |t| {
            let last = (1.0 - a * a - t * t).max(0.0).sqrt();
            integrate(c, last, |u| self.kernel.w((a * a + t * t + u * u).sqrt()))
        })
    }

    /// The kernel over the eighth of space beyond a, b and c.
    fn corner(&self, a: f64, b: f64, c: f64) -> f64 {
        integrate(a, (1.0 - b * b - c * c).max(0.0).sqrt(), |s| self.quarter_plane(s, b, c))
    }

    /// The kernel over the union of the solids behind three sides; sides beyond the support have q >= 1.
    fn union(&self, q: [f64; 3]) -> f64 {
        let single: f64 = q.iter().filter(|&&q| q < 1.0).map(|&q| self.half_space(q)).sum();
        let pair = |a: usize, b: usize| {
            if q[a] * q[a] + q[b] * q[b] < 1.0 { self.edge(q[a], q[b]) } else { 0.0 }
        };
        single - pair(0, 1) - pair(0, 2) - pair(1, 2)
            + if meet(q) { self.corner(q[0], q[1], q[2]) } else { 0.0 }
    }

    /// Minus the derivative of `union` by q[k].
    fn slope(&self, q: [f64; 3], k: usize) -> f64 {
        if q[k] >= 1.0 {
            return 0.0;
        }
        let [a, b] = [(k + 1) % 3, (k + 2) % 3];
        let pair = |o: usize| {
            if q[k] * q[k] + q[o] * q[o] < 1.0 { self.half_plane(q[k], q[o]) } else { 0.0 }
        };
        self.plane(q[k]) - pair(a) - pair(b)
            + if meet(q) { self.quarter_plane(q[k], q[a], q[b]) } else { 0.0 }
    }
}

fn meet(q: [f64; 3]) -> bool {
    q.iter().map(|q| q * q).sum::<f64>() < 1.0
}

/// The quadratures of the two kernels.
pub struct Solids {
    density: Solid,
    gradient: Solid,
}

impl Solids {
    pub fn new(kernels: Kernels) -> Self {
        Self { density: Solid::new(kernels.density), gradient: Solid::new(kernels.gradient) }
    }

    pub fn at(&self, params: &Params, x: DVec3) -> Wall {
        let h = f64::from(params.support_radius);
        let (mut distance, mut normal) = ([f64::INFINITY; 3], DVec3::ZERO);
        for axis in 0..3 {
            let sides = [
                (x[axis] - f64::from(params.domain_min[axis]), 1.0),
                (f64::from(params.domain_max[axis]) - x[axis], -1.0),
            ];
            for (side, (d, sign)) in sides.into_iter().enumerate() {
                if params.closed >> (2 * axis + side) & 1 == 1 && d < distance[axis] {
                    (distance[axis], normal[axis]) = (d, sign);
                }
            }
        }
        let q = distance.map(|d| d / h);
        let behind = distance.map(|d| (d + f64::from(params.wall_offset)) / h);
        // G points into the solid, the direction in which the integral increases.
        let gradient = |k: usize| -self.gradient.slope(q, k) / h * normal[k];
        Wall {
            density: self.density.union(behind),
            gradient: DVec3::new(gradient(0), gradient(1), gradient(2)),
            plane: q.map(|q| if q < 1.0 { self.gradient.half_space(q) } else { 0.0 }),
            normal,
            single: q.map(|q| if q < 1.0 { self.gradient.plane(q) } else { 0.0 }),
            distance: distance.map(|d| (d < h).then_some(d)),
            near: q.iter().filter(|&&q| q < 1.0).count(),
        }
    }
}

/// Tests the quadratures against analytic values.
#[test]
fn quadratures_agree_with_analytic_values() {
    for kernel in [Kernel::WendlandC2, Kernel::CubicSpline, Kernel::Poly6, Kernel::Spiky] {
        let solid = Solid::new(kernel);
        assert!((solid.half_space(0.0) - 0.5).abs() < 1e-7, "{kernel:?}");
        assert!((solid.edge(0.0, 0.0) - 0.25).abs() < 1e-4, "{kernel:?} {}", solid.edge(0.0, 0.0));
        assert!((solid.corner(0.0, 0.0, 0.0) - 0.125).abs() < 1e-4, "{kernel:?}");
        for q in [[0.3, 0.4, 0.5], [0.1, 0.2, 2.0], [0.2, 0.1, 0.05]] {
            for k in 0..3 {
                let mut ends = [q, q];
                ends[0][k] += 0.01;
                ends[1][k] -= 0.01;
                let numerical = (solid.union(ends[1]) - solid.union(ends[0])) / 0.02;
                assert!((numerical - solid.slope(q, k)).abs() < 2e-3, "{kernel:?} {q:?} {k}");
            }
        }
    }
    // Closed form of the half-space: 1/2 (1-q)^6 (3q^2 + 3q + 1).
    let solid = Solid::new(Kernel::WendlandC2);
    let closed = 0.5 * 0.7_f64.powi(6) * (0.27 + 0.9 + 1.0);
    assert!((solid.half_space(0.3) - closed).abs() < 1e-8);
}
