use glam::Vec4Swizzles;
use rayon::prelude::*;

use super::StartBindings;
use crate::bodies::reaction::{self, Totals};
use crate::bodies::types::{Body, Contact};
use crate::bodies::viscous::friction;

/// Particles per task.
const CHUNK: usize = 4096;

pub(super) fn viscous_friction(buffers: StartBindings<'_>) {
    let StartBindings {
        params,
        state,
        viscous,
        bodies,
        contacts,
        sorted_positions: positions,
        sorted_velocities: velocities,
        viscous_residuals,
        sums,
    } = buffers;
    if viscous.stopped != 0 {
        return;
    }
    let n = state.run_count as usize;
    let contacts = contacts.as_chunks::<2>().0;
    let totals: Vec<Totals> = viscous_residuals[..n]
        .par_chunks_mut(CHUNK)
        .enumerate()
        .map(|(chunk, residuals)| {
            let mut totals = Totals::new();
            for (k, r) in residuals.iter_mut().enumerate() {
                let i = chunk * CHUNK + k;
                if positions[i].w != 0.0 || contacts[i][0].body == Contact::NONE || r.w == 0.0 {
                    continue;
                }
                let x = positions[i].xyz();
                let (mut residual, mut rates) = (r.xyz(), 0.0);
                for contact in contacts[i].iter().filter(|contact| contact.body != Contact::NONE) {
                    let body = &bodies[contact.body as usize];
                    let rate = friction::rate(params, body, contact);
                    let v = velocities[i].xyz() - body.velocity_at(x);
                    let a = rate * friction::along(params, contact, v);
                    residual -= state.dt * a;
                    rates += rate;
                    if body.kind == Body::DYNAMIC {
                        totals.resize(bodies.len(), [0; 6]);
                        let force = params.particle_mass * a;
                        reaction::react(&mut totals[contact.body as usize], params, body, x, force);
                    }
                }
                *r = residual.extend(1.0 / (1.0 / r.w + state.dt * rates * 2.0 / 3.0));
            }
            totals
        })
        .collect();
    reaction::store(sums, &totals);
}
