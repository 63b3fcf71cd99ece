use glam::Vec4Swizzles;
use rayon::prelude::*;

use super::ForceBindings;
use crate::bodies::reaction::{self, Totals};
use crate::bodies::types::Contact;
use crate::bodies::viscous::friction;
use crate::bodies::viscous::unknowns::{SOLUTION, VECTORS, get};

/// Particles per task.
const CHUNK: usize = 4096;

pub(super) fn viscous_force(buffers: ForceBindings<'_>) {
    let ForceBindings {
        params,
        state,
        viscous,
        bodies,
        contacts,
        unknowns,
        sorted_positions: positions,
        sorted_velocities: velocities,
        viscous_residuals: residuals,
        predicted,
        sums,
    } = buffers;
    let n = state.run_count as usize;
    let contacts = contacts.as_chunks::<2>().0;
    let totals: Vec<Totals> = contacts[..n]
        .par_chunks(CHUNK)
        .enumerate()
        .map(|(chunk, pairs)| {
            let mut totals = Totals::new();
            for (k, pair) in pairs.iter().enumerate() {
                let i = chunk * CHUNK + k;
                // A nozzle, and not friction, determines the motion where there is no diagonal.
                if positions[i].w != 0.0 || pair[0].body == Contact::NONE || residuals[i].w == 0.0 {
                    continue;
                }
                totals.resize(bodies.len(), [0; 6]);
                let x = positions[i].xyz();
                let v = if viscous.updates == 0 { velocities[i].xyz() } else { predicted[i].xyz() };
                for contact in pair.iter().filter(|contact| contact.body != Contact::NONE) {
                    let b = contact.body as usize;
                    let [linear, angular] = get(&unknowns[VECTORS * b..], SOLUTION);
                    let wall = linear + angular.cross(x - bodies[b].position);
                    let rate = friction::rate(params, &bodies[b], contact);
                    let a = rate * friction::along(params, contact, v - wall);
                    reaction::react(&mut totals[b], params, &bodies[b], x, params.particle_mass * a);
                }
            }
            totals
        })
        .collect();
    reaction::store(sums, &totals);
}
