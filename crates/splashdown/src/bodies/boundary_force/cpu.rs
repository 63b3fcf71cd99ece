use glam::{Vec2, Vec3, Vec4, Vec4Swizzles};
use rayon::prelude::*;

use super::BoundaryForceBindings;
use crate::bodies::reaction::{self, Totals};
use crate::bodies::types::{Body, Contact};
use crate::boundary::{law, part};
use crate::state::{Params, Symmetric};

const CHUNK: usize = 4096;

pub(super) fn boundary_force<const FORCES: u32, const CORRECTED: bool>(buffers: BoundaryForceBindings<'_>) {
    let BoundaryForceBindings {
        params,
        state,
        bodies,
        contacts,
        sorted_positions: positions,
        sorted_velocities: velocities,
        densities,
        corrections,
        accelerations,
        sums,
    } = buffers;
    let n = state.run_count as usize;
    let (contacts, corrections) = (contacts.as_chunks::<2>().0, corrections.as_chunks::<2>().0);
    let wall_body = params.body_acceleration(state.time);
    let totals: Vec<Totals> = accelerations[..n]
        .par_chunks_mut(CHUNK)
        .enumerate()
        .map(|(chunk, accelerations)| {
            let mut totals = Totals::new();
            for (k, a) in accelerations.iter_mut().enumerate() {
                let i = chunk * CHUNK + k;
                if positions[i].w != 0.0 || contacts[i][0].body == Contact::NONE {
                    continue;
                }
                totals.resize(bodies.len(), [0; 6]);
                let forces = ParticleForces {
                    params,
                    dt: state.dt,
                    wall_body,
                    x: positions[i].xyz(),
                    v: velocities[i].xyz(),
                    density: densities[i],
                    correction: CORRECTED.then(|| Symmetric::from_vectors(corrections[i])),
                    contacts: &contacts[i],
                    bodies,
                };
                forces.apply::<FORCES>(a, &mut totals);
            }
            totals
        })
        .collect();
    reaction::store(sums, &totals);
}

/// The boundary forces on one particle.
struct ParticleForces<'a> {
    params: &'a Params,
    dt: f32,
    wall_body: Vec3,
    x: Vec3,
    v: Vec3,
    density: Vec2,
    /// The matrix that corrects the gradients, if they are corrected.
    correction: Option<Symmetric>,
    contacts: &'a [Contact; 2],
    bodies: &'a [Body],
}

impl ParticleForces<'_> {
    /// Adds the forces to the acceleration, and their reactions to the sums.
    fn apply<const FORCES: u32>(&self, acceleration: &mut Vec4, totals: &mut [[i64; 6]]) {
        let used = if self.contacts[1].body == Contact::NONE { 1 } else { 2 };
        // Body forces are among the other forces, and do not continue into the solid.
        let unchanged = if FORCES & part::OTHER != 0 { self.wall_body } else { Vec3::ZERO };
        let mut a = acceleration.xyz() - unchanged;
        let both = used == 2;
        let second = if both { self.effect::<FORCES>(1, both) } else { Vec3::ZERO };
        let mut reaction = [self.effect::<FORCES>(0, both), second];
        let scale = 1.0 / self.params.support_radius;
        let mut whole = a;
        for (k, contact) in self.contacts.iter().enumerate().take(used) {
            // The tangential acceleration continues unchanged into the solid, which exerts the missing part.
            let missing = contact.continued(whole, scale);
            whole += missing;
            reaction[k] += missing;
        }
        a += reaction[0] + reaction[1] + unchanged;
        for (k, reaction) in reaction.iter_mut().enumerate().take(used) {
            if FORCES & part::OTHER == 0 {
                break;
            }
            let contact = self.contact_acceleration(k, self.v + self.dt * a);
            a += contact;
            *reaction += contact;
        }
        *acceleration = a.extend(0.0);
        for (contact, reaction) in self.contacts.iter().zip(reaction).take(used) {
            let body = &self.bodies[contact.body as usize];
            let force = -self.params.particle_mass * reaction;
            let point = self.x - contact.distance * contact.normal;
            reaction::react(&mut totals[contact.body as usize], self.params, body, point, force);
        }
    }

    /// The acceleration by a body.
    fn effect<const FORCES: u32>(&self, k: usize, both: bool) -> Vec3 {
        let (params, contact) = (self.params, &self.contacts[k]);
        let other = &self.contacts[1 - k];
        let body = &self.bodies[contact.body as usize];
        let scale = 1.0 / params.support_radius;
        let (n, steep) = (contact.direction(scale), contact.slope.length());
        let across = n.dot(other.normal);
        let other_fraction = if both { other.kernel_fraction } else { 0.0 };
        let open = 1.0 - other_fraction * (1.0 - across * across);

        let [rho, pressure] = self.density.to_array();
        let pressure_factor = params.rest_density * pressure / (rho * rho) + pressure / params.rest_density;
        let effective = contact.effective.max(0.0);
        let mut a = Vec3::ZERO;
        if FORCES & part::PRESSURE != 0 {
            a = pressure_factor * contact.slope;
            if pressure_factor > 0.0 {
                a -= (contact.kernel_fraction + steep * effective) * n.dot(self.wall_body) * n;
            }
            a *= self.correction.map_or(1.0 / open.max(0.1), |matrix| matrix.along(n));
        }
        if FORCES & part::OTHER == 0 {
            return a;
        }

        let v = self.v - body.velocity_at(self.x);
        let vn = v.dot(n);
        let q = (effective * scale).min(1.0);
        if vn < 0.0 {
            a -= law::implicit_rate(law::approach_damping(params, q), self.dt) * vn * n;
        }
        let viscosity = params.viscosity + params.boundary_viscosity;
        let friction = law::friction(params, body.friction, viscosity, steep, effective);
        a -= law::implicit_rate(friction, self.dt) * (v - vn * n);
        if q > 0.5 {
            let spline = (-4.0 * q * q + 6.0 * q - 2.0).max(0.0);
            a -= body.adhesion * (4.0 * spline).sqrt().sqrt() * n;
        }
        a
    }

    /// The contact acceleration that prevents a particle from entering a body, if `v` is its velocity after this step.
    fn contact_acceleration(&self, k: usize, v: Vec3) -> Vec3 {
        let contact = &self.contacts[k];
        let body = &self.bodies[contact.body as usize];
        let slowest = -law::contact_speed(self.params, contact.distance, self.dt);
        let toward = (v - body.velocity_at(self.x)).dot(contact.normal);
        let yielding = law::yielding(self.params, body.coupling);
        (slowest - toward).max(0.0) / (yielding * self.dt) * contact.normal
    }
}
