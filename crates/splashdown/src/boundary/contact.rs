//! What closed sides do to a particle.

use glam::Vec3;

use super::WallTerms;
use crate::passes::Params;

impl WallTerms {
    /// The acceleration in m/s^2, body forces left out, of a particle with velocity `v` on which its neighbours
    /// act with `fluid`, and whose pressure pushes with `push` (2 p / rho: its own and its image's) against a G
    /// of one metre:
    ///
    /// * across a wall the pressure pushes with -push G and, while it does, goes on growing hydrostatically in
    ///   the solid: -(D + A d / H) body, the half-space integral of a linear pressure;
    /// * along a wall everything goes on in the solid as it is in the fluid, and neighbours fill only 1 - D of
    ///   the kernel: their sum is divided by the 1 - D of the other axes' walls. Without it the fluid at side
    ///   walls sinks;
    /// * the speed towards a wall is damped, k = c0 H B with B = 7 (1-q)^5 (1+2q) / H^2 (the Morris operator
    ///   over a solid at rest), where the density is summed. The image's pressure does work that the density,
    ///   which knows of one G only, does not account for, so water in a tank would boil at 7 % of sqrt(g depth)
    ///   for ever, whatever the time step. Only towards the wall: damped both ways, a collapsing column leaves
    ///   a film standing on it. The continuity equation counts the image too and needs no damping;
    /// * friction along it, k = 2 nu A / (H d), the closed form for a velocity that goes linearly through the wall.
    ///
    /// The last two are implicit, k / (1 + k dt), and so stable for any k.
    pub fn acceleration(
        &self,
        params: &Params,
        v: Vec3,
        body: Vec3,
        fluid: Vec3,
        push: f32,
        dt: f32,
    ) -> Vec3 {
        let scale = 1.0 / params.support_radius;
        let open = Vec3::ONE - self.plane;
        let others = Vec3::new(open.y * open.z, open.z * open.x, open.x * open.y);
        let mut a = fluid / others;
        for axis in 0..3 {
            let distance = self.distance[axis].max(0.0);
            if distance >= params.support_radius {
                continue;
            }
            let mut own = push * self.slope[axis] * scale * self.normal[axis];
            if push > 0.0 {
                own -= (self.plane[axis] + self.plane_slope[axis] * scale * distance) * body[axis];
            }
            a[axis] += own / others[axis];
            if v[axis] * self.normal[axis] < 0.0 {
                let q = distance * scale;
                let t = 1.0 - q;
                let damping = params.wall_damping
                    * 7.0
                    * params.sound_speed
                    * scale
                    * t
                    * t
                    * t
                    * t
                    * t
                    * (1.0 + 2.0 * q);
                a[axis] -= damping / (1.0 + damping * dt) * v[axis];
            }
            let friction = params.wall_friction * 2.0 * params.viscosity * self.plane_slope[axis] * scale
                / distance.max(0.25 * params.particle_spacing);
            let mut along = v;
            along[axis] = 0.0;
            a -= friction / (1.0 + friction * dt) * along;
        }
        a
    }
}
