use glam::Vec4Swizzles;
use rayon::prelude::*;

use super::PressureReactionBindings;
use crate::bodies::reaction::{self, Totals};
use crate::bodies::types::{Body, Contact};
use crate::state::SolveState;

/// Particles per task.
const CHUNK: usize = 4096;

pub(super) fn pressure_reaction(buffers: PressureReactionBindings<'_>) {
    let PressureReactionBindings {
        params,
        state,
        solve,
        bodies,
        contacts,
        sorted_positions: positions,
        predicted,
        sums,
    } = buffers;
    if solve.stopped != 0 {
        return;
    }
    let n = state.run_count as usize;
    let totals: Vec<Totals> = contacts.as_chunks::<2>().0[..n]
        .par_chunks(CHUNK)
        .enumerate()
        .map(|(chunk, pairs)| {
            let mut totals = Totals::new();
            for (k, pair) in pairs.iter().enumerate() {
                let i = chunk * CHUNK + k;
                let pressure = predicted[i].w;
                if positions[i].w != 0.0 || pressure.is_nan() || pressure == SolveState::NO_PRESSURE {
                    continue;
                }
                for contact in pair.iter().filter(|contact| contact.body != Contact::NONE) {
                    let body = &bodies[contact.body as usize];
                    if body.kind == Body::DYNAMIC {
                        totals.resize(bodies.len(), [0; 6]);
                        let point = positions[i].xyz() - contact.distance * contact.normal;
                        let force = params.particle_mass * pressure * contact.solid_gradient();
                        reaction::react(&mut totals[contact.body as usize], params, body, point, force);
                    }
                }
            }
            totals
        })
        .collect();
    reaction::store(sums, &totals);
}
