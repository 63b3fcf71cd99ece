use glam::{Vec2, Vec4Swizzles};
use rayon::prelude::*;

use super::BoundaryDensityBindings;
use crate::bodies::types::Contact;
use crate::state::Symmetric;

const CHUNK: usize = 4096;

pub(super) fn boundary_density<const CONTINUITY: bool>(buffers: BoundaryDensityBindings<'_>) {
    let BoundaryDensityBindings {
        params,
        state,
        cell_start,
        bodies,
        contacts,
        sorted_positions: positions,
        sorted_velocities: velocities,
        corrections,
        densities,
    } = buffers;
    let n = cell_start[cell_start.len() - 2] as usize;
    let contacts = contacts.as_chunks::<2>().0;
    let corrections = corrections.as_chunks::<2>().0;
    let scale = 1.0 / params.support_radius;
    densities[..n].par_chunks_mut(CHUNK).enumerate().for_each(|(chunk, densities)| {
        for (k, density) in densities.iter_mut().enumerate() {
            let i = chunk * CHUNK + k;
            let pair = &contacts[i];
            if pair[0].body == Contact::NONE {
                continue;
            }
            let mut rho = density.x;
            if CONTINUITY {
                let (x, v) = (positions[i].xyz(), velocities[i]);
                let matrix = Symmetric::from_vectors(corrections[i]);
                let flow: f32 = pair
                    .iter()
                    .filter(|contact| contact.body != Contact::NONE)
                    .map(|contact| {
                        let approach = v.xyz() - bodies[contact.body as usize].velocity_at(x);
                        matrix.along(contact.direction(scale)) * contact.slope.dot(approach)
                    })
                    .sum();
                rho = params.bounded_density(rho - state.dt * 2.0 * v.w * flow);
            } else {
                rho += params.rest_density * (pair[0].density + pair[1].density).min(1.0);
            }
            *density = Vec2::new(rho, params.pressure_at(rho));
        }
    });
}
