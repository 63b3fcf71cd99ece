//! Sums over neighbours by brute force: every pair, in f64, with formulas taken independently from the papers.
//!
//! Every result includes the sum of the magnitudes of its terms: rounding errors are relative to that sum, not to the
//! difference that remains after cancellation.

use std::f64::consts::PI;

use glam::{DVec3, Vec4Swizzles};

use super::walls::{self, Reflection};
use super::world::World;

/// The kernels (W H^3, dW/dq H^3) as functions of q = r / H.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kernel {
    WendlandC2,
    WendlandBlend,
    CubicSpline,
    Poly6,
    Spiky,
}

impl Kernel {
    pub fn w(self, q: f64) -> f64 {
        if q >= 1.0 {
            return 0.0;
        }
        match self {
            Self::WendlandC2 => 21.0 / (2.0 * PI) * (1.0 - q).powi(4) * (1.0 + 4.0 * q),
            Self::WendlandBlend => {
                0.65 * Self::WendlandC2.w(q)
                    + 0.35 * 105.0 / (16.0 * PI) * (1.0 - q).powi(3) * (1.0 + 3.0 * q)
            }
            Self::CubicSpline if q <= 0.5 => 8.0 / PI * (6.0 * q.powi(3) - 6.0 * q.powi(2) + 1.0),
            Self::CubicSpline => 8.0 / PI * 2.0 * (1.0 - q).powi(3),
            Self::Poly6 => 315.0 / (64.0 * PI) * (1.0 - q * q).powi(3),
            Self::Spiky => 15.0 / PI * (1.0 - q).powi(3),
        }
    }

    fn dw(self, q: f64) -> f64 {
        if q >= 1.0 {
            return 0.0;
        }
        match self {
            Self::WendlandC2 => -210.0 / PI * q * (1.0 - q).powi(3),
            Self::WendlandBlend => {
                0.65 * Self::WendlandC2.dw(q) - 0.35 * 315.0 / (4.0 * PI) * q * (1.0 - q).powi(2)
            }
            Self::CubicSpline if q <= 0.5 => 48.0 / PI * q * (3.0 * q - 2.0),
            Self::CubicSpline => -48.0 / PI * (1.0 - q).powi(2),
            Self::Poly6 => -315.0 / (64.0 * PI) * 6.0 * q * (1.0 - q * q).powi(2),
            Self::Spiky => -45.0 / PI * (1.0 - q).powi(2),
        }
    }

    /// The gradient with respect to x_i for d = x_i - x_j; zero at the centre, where it has no direction.
    pub(super) fn gradient(self, d: DVec3, support: f64) -> DVec3 {
        let r = d.length();
        if r == 0.0 { DVec3::ZERO } else { d / r * self.dw(r / support) / support.powi(4) }
    }
}

/// A value and the sum of the magnitudes of its terms.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sum {
    pub value: DVec3,
    pub size: f64,
}

impl Sum {
    pub(super) fn add(&mut self, term: DVec3) {
        self.value += term;
        self.size += term.length();
    }

    pub(super) fn add_parts(&mut self, parts: &[DVec3]) {
        parts.iter().for_each(|&part| self.add(part));
    }
}

/// The constants in f64.
pub(super) struct C {
    pub support: f64,
    pub mass: f64,
    pub rest: f64,
    pub sound: f64,
    spacing: f64,
    pub body: DVec3,
    pub dt: f64,
}

pub(super) fn constants(world: &World) -> C {
    let p = &world.params;
    let phase = f64::from(p.oscillation_rate) * f64::from(world.state.time);
    C {
        support: p.support_radius.into(),
        mass: p.summed_mass.into(),
        rest: p.rest_density.into(),
        sound: p.sound_speed.into(),
        spacing: p.particle_spacing.into(),
        body: p.gravity.as_dvec3() + p.oscillation.as_dvec3() * phase.sin(),
        dt: world.state.dt.into(),
    }
}

pub(super) fn place(world: &World, i: usize) -> DVec3 {
    world.positions[i].xyz().as_dvec3()
}

pub(super) fn speed(world: &World, i: usize) -> DVec3 {
    world.velocities[i].xyz().as_dvec3()
}

/// Calls `visit(j, x_i - x, by, x - x_j)` for the images x within the support of all active particles, by all
/// reflections and by none.
pub(super) fn neighbours(world: &World, i: usize, mut visit: impl FnMut(usize, DVec3, &Reflection, DVec3)) {
    let (x, reach) = (place(world, i), f64::from(world.params.support_radius));
    for by in walls::reflections(&world.params) {
        for j in 0..world.active() {
            let image = by.sign * place(world, j) + by.shift;
            let d = x - image;
            if d.length_squared() < reach * reach {
                visit(j, d, &by, image - place(world, j));
            }
        }
    }
}

/// p = rho0 c0^2 / exponent ((rho/rho0)^exponent - 1).
pub fn pressure(world: &World, rho: f64) -> f64 {
    let p = &world.params;
    let exponent = f64::from(p.exponent);
    let rest = f64::from(p.rest_density);
    let value = rest * f64::from(p.sound_speed).powi(2) / exponent * ((rho / rest).powf(exponent) - 1.0);
    if p.clamp_pressure == 1 { value.max(0.0) } else { value }
}

/// rho_i = m sum W.
pub fn density(world: &World, kernel: Kernel) -> Vec<f64> {
    let c = constants(world);
    let sum = |i: usize| {
        let mut sum = 0.0;
        neighbours(world, i, |_, d, _, _| sum += kernel.w(d.length() / c.support));
        c.mass * sum / c.support.powi(3)
    };
    (0..world.active()).map(sum).collect()
}

/// n_i = H sum (m / rho_j) grad W.
pub fn normals(world: &World, kernel: Kernel) -> Vec<Sum> {
    let c = constants(world);
    let sum = |i: usize| {
        let mut sum = Sum::default();
        neighbours(world, i, |j, d, _, _| {
            sum.add(c.support * c.mass / f64::from(world.densities[j].x) * kernel.gradient(d, c.support));
        });
        sum
    };
    (0..world.active()).map(sum).collect()
}

/// The acceleration by the friction of the walls.
pub(super) fn friction(world: &World, c: &C, i: usize, kernel: Kernel) -> Sum {
    let p = &world.params;
    let wall = walls::at(p, kernel, place(world, i));
    let v = speed(world, i);
    let mut sum = Sum::default();
    for axis in 0..3 {
        let Some(distance) = wall.distance[axis] else { continue };
        let rate = f64::from(p.wall_friction) * 2.0 * f64::from(p.viscosity) * wall.gradient[axis]
            / distance.max(0.25 * c.spacing);
        sum.add(-rate / (1.0 + rate * c.dt) * (v - v[axis] * DVec3::AXES[axis]));
    }
    sum
}

/// The pressure of an image: that of the particle and the hydrostatic difference, but not below the smaller of the
/// particle's pressure and zero.
pub(super) fn continued(pressure: f64, more: f64) -> f64 {
    (pressure + more).max(pressure.min(0.0))
}

/// Akinci's cohesion kernel.
pub(super) fn cohesion(r: f64, h: f64) -> f64 {
    let spline = (h - r).powi(3) * r.powi(3);
    32.0 / (PI * h.powi(9)) * if 2.0 * r > h { spline } else { 2.0 * spline - h.powi(6) / 64.0 }
}

/// Which forces are summed.
#[derive(Clone, Copy)]
pub struct Parts {
    pub pressure: bool,
    pub other: bool,
}

impl Parts {
    pub const ALL: Self = Self { pressure: true, other: true };
}

/// Accelerations of the acceleration pass.
pub fn acceleration(world: &World, kernel: Kernel, parts: Parts) -> Vec<Sum> {
    let (c, p) = (constants(world), &world.params);
    let [nu, alpha, gamma] = [p.viscosity, p.artificial_viscosity, p.surface_tension].map(f64::from);
    let state = |i: usize| world.densities[i].as_dvec2();
    let sum = |i: usize| {
        let mut sum = Sum::default();
        neighbours(world, i, |j, d, by, away| {
            let g = kernel.gradient(d, c.support);
            let (own, other) = (state(i), state(j));
            if parts.pressure {
                sum.add_parts(&[
                    -c.mass * own.y / own.x.powi(2) * g,
                    // The difference is for the density at rest.
                    -c.mass * continued(other.y / other.x.powi(2), c.body.dot(away) / c.rest) * g,
                ]);
            }
            if !parts.other {
                return;
            }
            let softened = d.length_squared() + 0.01 * c.support.powi(2);
            let approach = (speed(world, i) - by.sign * speed(world, j)).dot(d);
            sum.add(10.0 * nu * c.mass / c.rest * approach / softened * g);
            if approach < 0.0 {
                // -m Pi grad W with Pi = -alpha c0 mu / rho0, mu = h v.x / (r^2 + 0.01 H^2), h = H / 2.
                let mu = 0.5 * c.support * approach / softened;
                sum.add(c.mass * alpha * c.sound * mu / c.rest * g);
            }
            if gamma > 0.0 {
                let k = -gamma * 2.0 * c.rest / (own.x + other.x);
                let r = d.length();
                let pull = if r == 0.0 { DVec3::ZERO } else { c.mass * cohesion(r, c.support) * d / r };
                let [a, b] = [i, j].map(|k| world.normals[k].xyz().as_dvec3());
                sum.add_parts(&[k * pull, k * a, -k * by.sign * b]);
            }
        });
        if parts.other {
            let friction = friction(world, &c, i, kernel);
            sum.add_parts(&[c.body, friction.value]);
        }
        sum
    };
    (0..world.active()).map(sum).collect()
}

/// The gradient of the colour field over its threshold, per particle: near one, rounding determines whether there is
/// surface tension.
pub struct Steepness(pub f64);

/// Accelerations of Mueller 2003.
pub fn mueller(world: &World) -> Vec<(Sum, Steepness)> {
    let (c, p) = (constants(world), &world.params);
    let [nu, sigma] = [p.viscosity, p.surface_tension].map(f64::from);
    let state = |i: usize| world.densities[i].as_dvec2();
    let sum = |i: usize| {
        let (own, h) = (state(i), c.support);
        let mut sum = Sum::default();
        let (mut normal, mut laplacian) = (Sum::default(), Sum::default());
        neighbours(world, i, |j, d, by, away| {
            let other = state(j);
            let (volume, r) = (c.mass / other.x, d.length());
            let push = -volume * Kernel::Spiky.gradient(d, h) / (2.0 * own.x);
            let image = continued(other.y, c.rest * c.body.dot(away));
            sum.add_parts(&[push * own.y, push * image]);
            let rub = nu * c.rest * volume * 45.0 / (PI * h.powi(6)) * (h - r);
            sum.add(rub * (by.sign * speed(world, j) - speed(world, i)) / own.x);
            normal.add(volume * Kernel::Poly6.gradient(d, h));
            let second = -945.0 / (32.0 * PI * h.powi(9)) * (h * h - r * r) * (3.0 * h * h - 7.0 * r * r);
            laplacian.add(DVec3::X * volume * second);
        });
        let steepness = normal.value.length();
        if steepness > 0.5 / h {
            let per = sigma / own.x / steepness;
            sum.value -= per * laplacian.value.x * normal.value;
            // The uncertainty of the direction of a nearly cancelled sum is that of its terms.
            sum.size += per * (laplacian.size * steepness + laplacian.value.x.abs() * normal.size);
        }
        sum.add_parts(&[c.body, friction(world, &c, i, Kernel::Spiky).value]);
        (sum, Steepness(steepness * 2.0 * h))
    };
    (0..world.active()).map(sum).collect()
}
