use glam::{Vec3, Vec4, Vec4Swizzles};
use rayon::prelude::*;

use super::SolidGradientBindings;
use crate::bodies::types::Contact;

/// Particles per task.
const CHUNK: usize = 4096;

pub(super) fn solid_gradient(buffers: SolidGradientBindings<'_>) {
    let SolidGradientBindings {
        params,
        state,
        bodies,
        contacts,
        sorted_positions: positions,
        stiffness,
        solid_gradients,
    } = buffers;
    let n = state.run_count as usize;
    let contacts = contacts.as_chunks::<2>().0;
    let chunks = solid_gradients[..n].par_chunks_mut(CHUNK).zip(stiffness[..n].par_chunks_mut(CHUNK));
    chunks.enumerate().for_each(|(chunk, (gradients, stiffness))| {
        for (k, (out, stiffness)) in gradients.iter_mut().zip(stiffness).enumerate() {
            let i = chunk * CHUNK + k;
            if positions[i].w != 0.0 {
                continue;
            }
            let (mut sum, mut approach) = (Vec3::ZERO, 0.0);
            for contact in contacts[i].iter().filter(|contact| contact.body != Contact::NONE) {
                let (body, gradient) = (&bodies[contact.body as usize], contact.solid_gradient());
                sum += gradient;
                approach += gradient.dot(body.velocity_at(positions[i].xyz()));
                stiffness.w += params.rest_density * body.coupling * gradient.length();
            }
            *out = Vec4::from((sum, approach));
        }
    });
}
