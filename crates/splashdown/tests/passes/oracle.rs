//! Sums over neighbours by brute force: every pair, in f64, with formulas taken independently from the papers.
//!
//! Every result includes the sum of the magnitudes of its terms: rounding errors are relative to that sum, not to the
//! difference that remains after cancellation.

use std::f64::consts::PI;

use glam::{DVec3, Vec4Swizzles};

use super::walls::{Kernels, Wall};
use super::world::World;

/// The kernels (W H^3, dW/dq H^3) as functions of q = r / H.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kernel {
    WendlandC2,
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
            Self::CubicSpline if q <= 0.5 => 48.0 / PI * q * (3.0 * q - 2.0),
            Self::CubicSpline => -48.0 / PI * (1.0 - q).powi(2),
            Self::Poly6 => -315.0 / (64.0 * PI) * 6.0 * q * (1.0 - q * q).powi(2),
            Self::Spiky => -45.0 / PI * (1.0 - q).powi(2),
        }
    }

    /// The gradient with respect to x_i for d = x_i - x_j; zero at the centre, where it has no direction.
    fn gradient(self, d: DVec3, support: f64) -> DVec3 {
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
    fn add(&mut self, term: DVec3) {
        self.value += term;
        self.size += term.length();
    }

    fn add_parts(&mut self, parts: &[DVec3]) {
        parts.iter().for_each(|&part| self.add(part));
    }
}

/// The constants in f64.
struct C {
    support: f64,
    mass: f64,
    rest: f64,
    sound: f64,
    spacing: f64,
    body: DVec3,
    dt: f64,
}

fn constants(world: &World) -> C {
    let p = &world.params;
    let phase = f64::from(p.oscillation_rate) * f64::from(world.state.time);
    C {
        support: p.support_radius.into(),
        mass: p.particle_mass.into(),
        rest: p.rest_density.into(),
        sound: p.sound_speed.into(),
        spacing: p.particle_spacing.into(),
        body: p.gravity.as_dvec3() + p.oscillation.as_dvec3() * phase.sin(),
        dt: world.state.dt.into(),
    }
}

fn place(world: &World, i: usize) -> DVec3 {
    world.positions[i].xyz().as_dvec3()
}

fn speed(world: &World, i: usize) -> DVec3 {
    world.velocities[i].xyz().as_dvec3()
}

/// Calls `visit(j, x_i - x_j)` for all active particles within the support, itself included.
fn neighbours(world: &World, i: usize, mut visit: impl FnMut(usize, DVec3)) {
    let (x, reach) = (place(world, i), f64::from(world.params.support_radius));
    for j in 0..world.active() {
        let d = x - place(world, j);
        if d.length_squared() < reach * reach {
            visit(j, d);
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

/// rho_i = m sum W + rho0 D.
pub fn density(world: &World, kernel: Kernel, walls: &[Wall]) -> Vec<f64> {
    let c = constants(world);
    let sum = |i: usize| {
        let mut sum = 0.0;
        neighbours(world, i, |_, d| sum += kernel.w(d.length() / c.support));
        c.mass * sum / c.support.powi(3) + c.rest * walls[i].density
    };
    (0..world.active()).map(sum).collect()
}

/// n_i = H sum (m / rho_j) grad W.
pub fn normals(world: &World, kernel: Kernel) -> Vec<Sum> {
    let c = constants(world);
    let sum = |i: usize| {
        let mut sum = Sum::default();
        neighbours(world, i, |j, d| {
            sum.add(c.support * c.mass / f64::from(world.densities[j].x) * kernel.gradient(d, c.support));
        });
        sum
    };
    (0..world.active()).map(sum).collect()
}

/// The density after a step of the continuity equation; `value.x` of the sum.
pub fn continuity(world: &World, kernel: Kernel, walls: &[Wall]) -> Vec<Sum> {
    let (c, delta) = (constants(world), f64::from(world.params.density_diffusion));
    let rho = |i: usize| f64::from(world.velocities[i].w);
    let step = |i: usize| {
        let mut sum = Sum::default();
        let mut add = |term: f64| sum.add(DVec3::X * term);
        add(rho(i));
        neighbours(world, i, |j, d| {
            let (g, volume) = (kernel.gradient(d, c.support), c.mass / rho(j));
            add(c.dt * rho(i) * volume * (speed(world, i) - speed(world, j)).dot(g));
            // The hydrostatic density difference: rho0 / c0^2 body.(x_j - x_i).
            let still = c.rest / c.sound.powi(2) * c.body.dot(-d);
            let psi = rho(j) - rho(i) - still;
            let softened = d.length_squared() + 0.01 * c.support.powi(2);
            add(c.dt * 2.0 * delta * (0.5 * c.support) * c.sound * volume * psi * (-d).dot(g) / softened);
        });
        // The velocity of the walls is the mirrored velocity of the particle: twice v.G.
        add(c.dt * 2.0 * rho(i) * speed(world, i).dot(walls[i].gradient));
        sum
    };
    (0..world.active()).map(step).collect()
}

/// The sum of the neighbours (`pairs`) and of the walls, whose pressure force has the factor `push` = 2 p / rho.
fn contact(world: &World, c: &C, i: usize, wall: &Wall, pairs: Sum, push: f64, parts: Parts) -> Sum {
    let p = &world.params;
    let v = speed(world, i);
    let mut sum = Sum::default();
    if parts.other {
        sum = Sum { value: c.body, size: c.body.length() };
    }
    for axis in 0..3 {
        let e = DVec3::AXES[axis];
        // Along the walls of the other axes the state is that of the fluid, of which the kernel covers only this part.
        let seen = (1.0 - wall.plane[(axis + 1) % 3]) * (1.0 - wall.plane[(axis + 2) % 3]);
        sum.value += pairs.value[axis] / seen * e;
        sum.size += pairs.size / seen;
        let Some(distance) = wall.distance[axis] else { continue };
        if parts.pressure {
            let mut own = -push * wall.gradient[axis];
            sum.size += own.abs() / seen;
            if push > 0.0 {
                let fraction = wall.plane[axis] + wall.single[axis] * distance / c.support;
                own -= fraction * c.body[axis];
            }
            sum.add(own / seen * e);
        }
        if !parts.other {
            continue;
        }
        let q = distance / c.support;
        let implicit = |k: f64| k / (1.0 + k * c.dt);
        if v[axis] * wall.normal[axis] < 0.0 {
            let morris = 7.0 * (1.0 - q).powi(5) * (1.0 + 2.0 * q) / c.support.powi(2);
            let damping = f64::from(p.wall_damping) * c.sound * c.support * morris;
            sum.add(-implicit(damping) * v[axis] * e);
        }
        let friction = f64::from(p.wall_friction) * 2.0 * f64::from(p.viscosity) * wall.single[axis]
            / (c.support * distance.max(0.25 * c.spacing));
        sum.add(-implicit(friction) * (v - v[axis] * e));
    }
    sum
}

/// Akinci's cohesion kernel.
fn cohesion(r: f64, h: f64) -> f64 {
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
pub fn acceleration(world: &World, kernel: Kernel, walls: &[Wall], parts: Parts) -> Vec<Sum> {
    let (c, p) = (constants(world), &world.params);
    let [nu, alpha, gamma] = [p.viscosity, p.artificial_viscosity, p.surface_tension].map(f64::from);
    let state = |i: usize| world.densities[i].as_dvec2();
    let sum = |i: usize| {
        let mut sum = Sum::default();
        neighbours(world, i, |j, d| {
            if i == j {
                return;
            }
            let g = kernel.gradient(d, c.support);
            let (own, other) = (state(i), state(j));
            if parts.pressure {
                sum.add_parts(&[
                    -c.mass * own.y / own.x.powi(2) * g,
                    -c.mass * other.y / other.x.powi(2) * g,
                ]);
            }
            if !parts.other {
                return;
            }
            let softened = d.length_squared() + 0.01 * c.support.powi(2);
            let approach = (speed(world, i) - speed(world, j)).dot(d);
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
                sum.add_parts(&[k * pull, k * a, -k * b]);
            }
        });
        // The image in the wall has the rest density.
        let own = state(i);
        let push = c.rest * (own.y / own.x.powi(2) + own.y / c.rest.powi(2));
        contact(world, &c, i, &walls[i], sum, push, parts)
    };
    (0..world.active()).map(sum).collect()
}

/// The gradient of the colour field over its threshold, per particle: near one, rounding determines whether there is
/// surface tension.
pub struct Steepness(pub f64);

/// Accelerations of Mueller 2003.
pub fn mueller(world: &World, walls: &[Wall]) -> Vec<(Sum, Steepness)> {
    let (c, p) = (constants(world), &world.params);
    let [nu, sigma] = [p.viscosity, p.surface_tension].map(f64::from);
    let state = |i: usize| world.densities[i].as_dvec2();
    let sum = |i: usize| {
        let (own, h) = (state(i), c.support);
        let mut sum = Sum::default();
        let (mut normal, mut laplacian) = (Sum::default(), Sum::default());
        neighbours(world, i, |j, d| {
            let other = state(j);
            let (volume, r) = (c.mass / other.x, d.length());
            let push = -volume * Kernel::Spiky.gradient(d, h) / (2.0 * own.x);
            sum.add_parts(&[push * own.y, push * other.y]);
            let rub = nu * c.rest * volume * 45.0 / (PI * h.powi(6)) * (h - r);
            sum.add(rub * (speed(world, j) - speed(world, i)) / own.x);
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
        (contact(world, &c, i, &walls[i], sum, own.y / own.x, Parts::ALL), Steepness(steepness * 2.0 * h))
    };
    (0..world.active()).map(sum).collect()
}

/// The walls of every active particle.
pub fn walls(world: &World, kernels: Kernels) -> Vec<Wall> {
    let solids = super::walls::Solids::new(kernels);
    (0..world.active()).map(|i| solids.at(&world.params, place(world, i))).collect()
}
