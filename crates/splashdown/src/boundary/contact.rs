//! The forces of closed sides on a particle: pressure, and all others.

use glam::Vec3;

use super::{WallTerms, law, part};
use crate::state::Params;

impl WallTerms {
    /// The acceleration in m/s^2 of a particle by its neighbours and the walls, without body forces.
    ///
    /// `FORCES` selects the [`part`] that is computed; `fluid` is the same part of the acceleration by the neighbours.
    /// `v` is the velocity of the particle. `pressure_factor` is the acceleration by the pressure of the particle and
    /// of its image, per unit of G in 1/m: about 2 p / rho in `wcsph`, p / rho in `mueller2003`.
    ///
    /// All forces: neighbours fill only 1 - D of the kernel beside a wall, and the fluid continues unchanged along
    /// the wall. So the sum over the neighbours is divided by the 1 - D of the walls of the other axes. Without
    /// this the fluid at side walls sinks.
    ///
    /// Pressure: -pressure_factor G across the wall. A positive pressure continues to grow hydrostatically inside the
    /// solid: -(D + A d / H) body, the half-space integral of a linear pressure.
    ///
    /// Other forces:
    ///
    /// * The velocity towards a wall is damped where the density is summed, k = c0 H B with
    ///   B = 7 (1-q)^5 (1+2q) / H^2 (the Morris operator over a solid at rest). The pressure of the image does work
    ///   that the summed density, which has a single G, does not account for; without damping, water in a tank
    ///   moves at 7 % of sqrt(g depth) at any time step. Damping in both directions was tried: it leaves a film
    ///   on the wall behind a collapsing column. The continuity equation includes the image and needs no damping.
    /// * Friction along the wall, k = 2 nu A / (H d): the closed form for a velocity that is linear across the wall.
    ///
    /// Damping and friction are implicit, k / (1 + k dt), and stable for any k.
    pub fn acceleration<const FORCES: u32>(
        &self,
        params: &Params,
        v: Vec3,
        body: Vec3,
        fluid: Vec3,
        pressure_factor: f32,
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
            if FORCES & part::PRESSURE != 0 {
                let mut own = pressure_factor * self.slope[axis] * scale * self.normal[axis];
                if pressure_factor > 0.0 {
                    own -= (self.plane[axis] + self.plane_slope[axis] * scale * distance) * body[axis];
                }
                a[axis] += own / others[axis];
            }
            if FORCES & part::OTHER == 0 {
                continue;
            }
            if v[axis] * self.normal[axis] < 0.0 {
                a[axis] -= law::implicit_rate(law::approach_damping(params, distance * scale), dt) * v[axis];
            }
            let gradient = self.plane_slope[axis] * scale;
            let friction = law::friction(params, params.wall_friction, params.viscosity, gradient, distance);
            let mut along = v;
            along[axis] = 0.0;
            a -= law::implicit_rate(friction, dt) * along;
        }
        a
    }
}
