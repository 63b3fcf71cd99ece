//! The sums with corrected gradients by brute force in f64.

use glam::{DMat3, DVec3, Vec4Swizzles};

use super::oracle::{self, Kernel, Sum, cohesion, constants, continued, neighbours, speed};
use super::world::World;

/// What the continuity pass writes for a particle. Each value has the magnitude of its terms.
pub struct Continued {
    pub density: (f64, f64),
    pub matrix: DMat3,
    pub matrix_size: f64,
    pub shifting: (f64, f64),
}

/// a (x) b.
fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}

fn contract(a: DMat3, b: DMat3) -> f64 {
    (0..3).map(|k| a.col(k).dot(b.col(k))).sum()
}

/// B fades from the inverse to the unit matrix as the determinant falls below one.
fn correction(matrix: DMat3) -> DMat3 {
    let determinant = matrix.determinant();
    let (a, b, d) = (matrix.x_axis, matrix.y_axis, matrix.z_axis);
    let adjugate = DMat3::from_cols(b.cross(d), d.cross(a), a.cross(b)).transpose();
    adjugate * (1.0 / determinant.max(1.0)) + DMat3::IDENTITY * (1.0 - determinant.clamp(0.0, 1.0))
}

/// The first three components of a particle's two vectors as a symmetric matrix.
pub(super) fn symmetric(vectors: &[glam::Vec4], i: usize) -> DMat3 {
    let (d, o) = (vectors[2 * i].xyz().as_dvec3(), vectors[2 * i + 1].xyz().as_dvec3());
    DMat3::from_cols(DVec3::new(d.x, o.x, o.y), DVec3::new(o.x, d.y, o.z), DVec3::new(o.y, o.z, d.z))
}

/// A step of the continuity equation. `boundary`: the contributions of bodies, two vectors per particle.
pub fn continuity(world: &World, kernel: Kernel, boundary: Option<&[glam::Vec4]>) -> Vec<Continued> {
    let (c, delta) = (constants(world), f64::from(world.params.density_diffusion));
    let rho = |i: usize| f64::from(world.velocities[i].w);
    let step = |i: usize| {
        let (mut matrix, mut gradient) = (DMat3::ZERO, DMat3::ZERO);
        let (mut matrix_size, mut gradient_size) = (0.0, 0.0);
        let mut diffusion = Sum::default();
        neighbours(world, i, |j, d, by, away| {
            let volume = c.mass / rho(j);
            let g = volume * kernel.gradient(d, c.support);
            let v = speed(world, i) - by.sign * speed(world, j);
            matrix -= outer(d, g);
            gradient += outer(v, g);
            matrix_size += d.length() * g.length();
            gradient_size += v.length() * g.length();
            // The hydrostatic density difference: rho0 / c0^2 body.(x_j - x_i).
            let per_length = c.rest / c.sound.powi(2) * c.body;
            // That of an image continues the particle's.
            let psi = rho(j) + per_length.dot(away) - rho(i) - per_length.dot(-d);
            let softened = d.length_squared() + 0.01 * c.support.powi(2);
            diffusion
                .add(DVec3::X * 2.0 * delta * (0.5 * c.support) * c.sound * psi * (-d).dot(g) / softened);
        });
        let (mut open, mut away, mut alone) = (1.0, 1.0, None);
        if let Some(vectors) = boundary {
            // Across the surfaces of bodies and, for the pressure, along them.
            let (across, fraction) = (symmetric(vectors, i), f64::from(vectors[2 * i].w));
            matrix += across;
            alone = Some(matrix);
            if fraction > 0.0 {
                let trace = across.x_axis.x + across.y_axis.y + across.z_axis.z;
                matrix += fraction * (DMat3::IDENTITY - across * (1.0 / trace));
            }
            matrix_size += 1.0;
            open = (1.0 - 20.0 * f64::from(vectors[2 * i].w)).max(0.0);
            away = (1.0 - 100.0 * f64::from(vectors[2 * i].w)).max(0.0);
        }
        let determinant = matrix.determinant();
        let (determinant_size, inverse_size) = (matrix_size.powi(3), 1.0 + matrix_size.powi(2));
        let corrected = correction(matrix);
        let matrix_error = inverse_size * (1.0 + determinant_size);
        let strain = 0.5 * (gradient + gradient.transpose());
        // The density follows the positions, where it is too low, or inside the fluid: below a determinant of 0.82 a deficit
        // does not count.
        let excess = (0..3).map(|k| matrix.col(k)[k]).sum::<f64>()
            / (3.0 * f64::from(world.params.lattice_moment))
            - 1.0;
        let inside = if excess > 0.0 { 1.0 } else { ((determinant - 0.82) / 0.08).clamp(0.0, 1.0) };
        let recovery = away * 4.0 * contract(strain, strain).sqrt() * inside * excess;
        // Rounding of the determinant matters where a deficit fades.
        let fading =
            if excess < 0.0 && (0.7..1.0).contains(&determinant) { 12.5 * determinant_size } else { 0.0 };
        let recovery_size = away * 4.0 * gradient_size * (1.0 + matrix_size) * (1.0 + fading);
        let rate =
            rho(i) * (contract(alone.map_or(corrected, correction), strain) + recovery) + diffusion.value.x;
        let rate_size = rho(i) * (matrix_error * gradient_size + recovery_size) + diffusion.size;
        let next = rho(i) + c.dt * rate;
        // Fragments keep no deficit of density.
        let kept = (4.0 * determinant).clamp(0.0, 1.0);
        let density = if next < c.rest { c.rest + kept * (next - c.rest) } else { next };
        let deficit = (c.rest - next).max(0.0);
        // Zero at a determinant of 0.45, one at 0.9.
        let complete = ((determinant - 0.45) / 0.45).clamp(0.0, 1.0);
        let scale = away * 4.0 * c.support.powi(2);
        // In scenes with bodies, fluid almost at rest is not shifted at a support of two spacings.
        let narrow = (3.0 - c.support / f64::from(world.params.particle_spacing)).clamp(0.0, 1.0);
        let with_bodies = f64::from(u8::from(boundary.is_some()));
        let rest = with_bodies * narrow * 0.1 * (world.params.gravity.as_dvec3().length() / c.support).sqrt();
        let deformation = (contract(strain, strain).sqrt() - rest).max(0.0);
        Continued {
            density: (density, rho(i) + c.dt * rate_size + 4.0 * determinant_size * deficit),
            // Where a body fills a twentieth of the kernel, gradients are not corrected.
            matrix: open * corrected
                + (1.0 - open) / f64::from(world.params.lattice_moment) * DMat3::IDENTITY,
            matrix_size: matrix_error,
            shifting: (
                scale * complete * deformation,
                scale * gradient_size * (1.0 + 3.0 * determinant_size),
            ),
        }
    };
    (0..world.active()).map(step).collect()
}

/// Accelerations with corrected gradients, and shifting velocities.
pub fn acceleration(world: &World, corrections: &[glam::Vec4], kernel: Kernel) -> Vec<(Sum, Sum)> {
    let (c, p) = (constants(world), &world.params);
    let [nu, alpha, gamma] = [p.viscosity, p.artificial_viscosity, p.surface_tension].map(f64::from);
    let state = |i: usize| world.densities[i].as_dvec2();
    let at_spacing = kernel.w(f64::from(p.particle_spacing) / c.support);
    let sums = |i: usize| {
        let (mut sum, mut shift) = (Sum::default(), Sum::default());
        neighbours(world, i, |j, d, by, away| {
            let g = kernel.gradient(d, c.support);
            let (own, other, r) = (state(i), state(j), d.length());
            let reflection = DMat3::from_diagonal(by.sign);
            let image = reflection * symmetric(corrections, j) * reflection;
            let pressure = continued(other.y / other.x.powi(2), c.body.dot(away) / c.rest);
            sum.add_parts(&[
                -c.mass * own.y / own.x.powi(2) * (symmetric(corrections, i) * g),
                // The difference is for the density at rest.
                -c.mass * pressure * (image * g),
            ]);
            let softened = d.length_squared() + 0.01 * c.support.powi(2);
            let approach = (speed(world, i) - by.sign * speed(world, j)).dot(d);
            sum.add(10.0 * nu * c.mass / c.rest * approach / softened * g);
            if approach < 0.0 {
                let limited = (-3.0 * approach * r / softened).min(c.sound);
                let speed = alpha * c.sound + limited;
                sum.add(c.mass / c.rest * 0.5 * c.support * speed * approach / softened * g);
            }
            if gamma > 0.0 {
                let k = -gamma * 2.0 * c.rest / (own.x + other.x);
                let pull = if r == 0.0 { DVec3::ZERO } else { c.mass * cohesion(r, c.support) * d / r };
                let [a, b] = [i, j].map(|k| world.normals[k].xyz().as_dvec3());
                sum.add_parts(&[k * pull, k * a, -k * by.sign * b]);
            }
            let near = kernel.w(r / c.support) / at_spacing;
            let coefficient = f64::from(corrections[2 * i].w);
            shift.add(-coefficient * c.mass / c.rest * (1.0 + 0.2 * near.powi(4)) * g);
        });
        let friction = oracle::friction(world, &c, i, kernel);
        sum.add_parts(&[c.body, friction.value]);
        (sum, shift)
    };
    (0..world.active()).map(sums).collect()
}
