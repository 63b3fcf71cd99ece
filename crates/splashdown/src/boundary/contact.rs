//! What closed sides do to a particle beside the push of its own pressure.

use glam::Vec3;

use super::WallTerms;
use crate::passes::Params;

impl WallTerms {
    /// Three parts, in m/s^2, for a particle with velocity `v`:
    ///
    /// * where the particle is `pressed` (its pressure is in force), the pressure that goes on growing hydrostatically in
    ///   the solid: -D body along the wall and across it, and -(c_k / H) d_k body_k across (the half-space integral of
    ///   a linear pressure). Without it the fluid at side walls lacks their share of the gradient and sinks;
    /// * damping of the speed across the wall, k = c0 H B with B = 7 (1-q)^5 (1+2q) / H^2 (the Morris operator over a
    ///   solid at rest). A mirrored pressure, 2 p_i G, does more work than the one G by which the density knows of the
    ///   wall accounts for, so a tank at rest would never come to rest: 7 % of sqrt(g depth) for ever; with the damping
    ///   it is under 1 %. Across a wall the fluid has no speed to lose;
    /// * friction along it, k = 2 nu A / (H d), the closed form for a velocity that goes linearly through the wall.
    ///
    /// Both are implicit, k / (1 + k dt), and so stable for any k.
    pub fn acceleration(&self, params: &Params, v: Vec3, body: Vec3, pressed: bool, dt: f32) -> Vec3 {
        let scale = 1.0 / params.support_radius;
        let mut a = if pressed { -self.density * body } else { Vec3::ZERO };
        for axis in 0..3 {
            let distance = self.distance[axis];
            if distance >= params.support_radius {
                continue;
            }
            if pressed {
                a[axis] -= self.slope[axis] * scale * distance * body[axis];
            }
            let q = distance.max(0.0) * scale;
            let t = 1.0 - q;
            let damping = 7.0 * params.sound_speed * scale * t * t * t * t * t * (1.0 + 2.0 * q);
            a[axis] -= damping / (1.0 + damping * dt) * v[axis];
            let friction = params.wall_friction * 2.0 * params.viscosity * self.single[axis] * scale
                / distance.max(0.25 * params.particle_spacing);
            let mut along = v;
            along[axis] = 0.0;
            a -= friction / (1.0 + friction * dt) * along;
        }
        a
    }
}
