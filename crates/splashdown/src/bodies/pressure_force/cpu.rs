use glam::Vec4Swizzles;
use rayon::prelude::*;

use super::PressureForceBindings;
use crate::bodies::reaction::{self, Totals};
use crate::bodies::types::Contact;
use crate::boundary::law;

/// Particles per task.
const CHUNK: usize = 4096;

pub(super) fn pressure_force(buffers: PressureForceBindings<'_>) {
    let PressureForceBindings {
        params,
        state,
        bodies,
        contacts,
        sorted_positions: positions,
        sorted_velocities: velocities,
        predicted,
        accelerations,
        sums,
    } = buffers;
    let n = state.run_count as usize;
    let scale = 1.0 / params.support_radius;
    let contacts = contacts.as_chunks::<2>().0;
    let totals: Vec<Totals> = accelerations[..n]
        .par_chunks_mut(CHUNK)
        .enumerate()
        .map(|(chunk, accelerations)| {
            let mut totals = Totals::new();
            for (k, whole) in accelerations.iter_mut().enumerate() {
                let i = chunk * CHUNK + k;
                if positions[i].w != 0.0 || contacts[i][0].body == Contact::NONE || whole.w == 1.0 {
                    continue;
                }
                totals.resize(bodies.len(), [0; 6]);
                let (x, pressure) = (positions[i].xyz(), predicted[i].w);
                let by_pressure = predicted[i].xyz();
                let mut a = whole.xyz();
                for contact in contacts[i].iter().filter(|contact| contact.body != Contact::NONE) {
                    let body = &bodies[contact.body as usize];
                    let missing = contact.continued(by_pressure, scale);
                    a += missing;
                    let v = velocities[i].xyz() + state.dt * a - body.velocity_at(x);
                    let slowest = -law::contact_speed(params, contact.distance, state.dt);
                    let yielding = law::yielding(params, body.coupling);
                    let stop = (slowest - v.dot(contact.normal)).max(0.0) / (yielding * state.dt);
                    let stop = stop * contact.normal;
                    a += stop;
                    let force = params.particle_mass * (pressure * contact.solid_gradient() - stop - missing);
                    let point = x - contact.distance * contact.normal;
                    reaction::react(&mut totals[contact.body as usize], params, body, point, force);
                }
                *whole = a.extend(0.0);
            }
            totals
        })
        .collect();
    reaction::store(sums, &totals);
}
