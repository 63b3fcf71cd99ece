use glam::{Vec3, Vec4, Vec4Swizzles};
use rayon::prelude::*;

use super::ProductBindings;
use crate::bodies::reaction::{self, Totals};
use crate::bodies::types::{Body, Contact};
use crate::bodies::viscous::friction;

/// Particles per task.
const CHUNK: usize = 4096;

pub(super) fn viscous_body_product(buffers: ProductBindings<'_>) {
    let ProductBindings {
        params,
        state,
        viscous,
        bodies,
        contacts,
        sorted_positions: positions,
        responses,
        viscous_residuals: residuals,
        viscous_products,
        sums,
    } = buffers;
    if viscous.stopped != 0 {
        return;
    }
    let n = state.run_count as usize;
    let contacts = contacts.as_chunks::<2>().0;
    let responses = responses.as_chunks::<2>().0;
    let totals: Vec<Totals> = viscous_products[..n]
        .par_chunks_mut(CHUNK)
        .enumerate()
        .map(|(chunk, products)| {
            let mut totals = Totals::new();
            for (k, product) in products.iter_mut().enumerate() {
                let i = chunk * CHUNK + k;
                *product = Vec4::ZERO;
                let r = residuals[i];
                if positions[i].w != 0.0 || contacts[i][0].body == Contact::NONE || r.w == 0.0 {
                    continue;
                }
                let x = positions[i].xyz();
                let mut sum = Vec3::ZERO;
                for contact in contacts[i].iter().filter(|contact| contact.body != Contact::NONE) {
                    let b = contact.body as usize;
                    let body = &bodies[b];
                    let wall = responses[b][0].xyz() + responses[b][1].xyz().cross(x - body.position);
                    let rate = friction::rate(params, body, contact);
                    let a = rate * friction::along(params, contact, r.w * r.xyz() - wall);
                    sum += a;
                    if body.kind == Body::DYNAMIC {
                        totals.resize(bodies.len(), [0; 6]);
                        reaction::react(&mut totals[b], params, body, x, params.particle_mass * a);
                    }
                }
                *product = (state.dt * sum).extend(0.0);
            }
            totals
        })
        .collect();
    reaction::store(sums, &totals);
}
