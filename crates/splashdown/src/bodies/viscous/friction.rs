//! The friction of a body on a particle.

use glam::Vec3;
use splashdown_gpu::WgslModule;

use crate::bodies::types::{Body, Contact};
use crate::boundary::law;
use crate::state::Params;

/// The WGSL side.
pub(super) const WGSL: WgslModule =
    WgslModule { name: "sph/viscous_friction", source: include_str!("friction.wgsl") };

/// The integral over t from q to 1 of (1 - t)(1 - 4/5 t)(t^3 - 2 q^2 t + q^4/t): that of the operator over a half-space at the
/// distance q, without its factor.
fn half_space(q: f32) -> f32 {
    let q2 = q * q;
    let third = q2 * q2 * (0.25 - 0.36 * q + q2 / 7.5);
    let first = q2 * (0.5 - 0.6 * q + 0.2 * q2);
    let inverse = q.max(1e-6).ln() - 1.8 * q + 0.4 * q2;
    0.07 / 3.0 - third - 2.0 * q2 * (0.1 - first) - q2 * q2 * (1.4 + inverse)
}

/// The rate in 1/s at which the velocity along a body is damped.
pub(super) fn rate(params: &Params, body: &Body, contact: &Contact) -> f32 {
    let effective = contact.effective.max(0.0);
    let q = (effective / params.support_radius).min(1.0);
    let distance = effective.max(law::CLEARANCE * params.particle_spacing);
    let integral = 131.25 * half_space(q).max(0.0) / (params.support_radius * distance);
    body.friction * params.implicit_viscosity * integral
}

/// The part of a relative velocity along the body.
pub(super) fn along(params: &Params, contact: &Contact, v: Vec3) -> Vec3 {
    let n = contact.direction(1.0 / params.support_radius);
    v - v.dot(n) * n
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against a sum over the half-space of the operator for a velocity that is linear across the surface.
    #[test]
    fn the_friction_balances_the_pull_of_a_shear_flow() {
        for q in [0.0_f64, 0.1, 0.25, 0.5, 0.75, 0.9] {
            // Spheres and zones: c d_x^2 d_y with c = 525 / pi F / r^2, over d_y > q.
            let (radii, zones) = (2000, 2000);
            let mut sum = 0.0;
            for k in 0..radii {
                let r = q + (1.0 - q) * (k as f64 + 0.5) / f64::from(radii);
                let low = q / r;
                for l in 0..zones {
                    let mu = low + (1.0 - low) * (l as f64 + 0.5) / f64::from(zones);
                    let weight = (1.0 - r) * (1.0 - 0.8 * r) / (r * r);
                    // The mean of the square of the cosine over the azimuth, times its circumference.
                    let square = std::f64::consts::PI * r * r * (1.0 - mu * mu);
                    sum += weight * square * r * mu * r * r * (1.0 - low) / f64::from(zones);
                }
            }
            let pull = 525.0 / std::f64::consts::PI * sum * (1.0 - q) / f64::from(radii);
            let friction = 131.25 * f64::from(half_space(q as f32));
            // The closed form is a difference of terms of order one.
            let allowed = 2e-3 * pull + 1e-4;
            assert!((friction - pull).abs() < allowed, "{q}: {friction} and {pull}");
        }
    }
}
