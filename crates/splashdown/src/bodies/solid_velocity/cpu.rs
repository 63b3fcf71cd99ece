use glam::Vec4Swizzles;
use rayon::prelude::*;

use super::SolidVelocityBindings;
use crate::bodies::types::Contact;

/// Particles per task.
const CHUNK: usize = 4096;

pub(super) fn solid_velocity(buffers: SolidVelocityBindings<'_>) {
    let SolidVelocityBindings {
        state,
        solve,
        bodies,
        contacts,
        sorted_positions: positions,
        responses,
        solid_gradients,
    } = buffers;
    if solve.stopped != 0 {
        return;
    }
    let n = state.run_count as usize;
    let contacts = contacts.as_chunks::<2>().0;
    let responses = responses.as_chunks::<2>().0;
    solid_gradients[..n].par_chunks_mut(CHUNK).enumerate().for_each(|(chunk, gradients)| {
        for (k, gradient) in gradients.iter_mut().enumerate() {
            let i = chunk * CHUNK + k;
            if positions[i].w != 0.0 || contacts[i][0].body == Contact::NONE {
                continue;
            }
            let near = contacts[i].iter().filter(|contact| contact.body != Contact::NONE);
            gradient.w = near
                .map(|contact| {
                    let b = contact.body as usize;
                    let arm = positions[i].xyz() - bodies[b].position;
                    let velocity = responses[b][0].xyz() + responses[b][1].xyz().cross(arm);
                    contact.solid_gradient().dot(velocity)
                })
                .sum();
        }
    });
}
