use rayon::prelude::*;

use super::CollideBindings;
use crate::bodies;
use crate::foam::DiffuseKind;

pub(super) fn collide(buffers: CollideBindings<'_>) {
    let CollideBindings { foam_state, bodies, maps, foam_pool: pool } = buffers;
    if foam_state.is_due == 0 {
        return;
    }
    let n = foam_state.count as usize;
    pool[..n].par_iter_mut().with_min_len(1024).for_each(|particle| {
        for body in bodies {
            let Some((distance, normal)) = bodies::penetration(body, maps, particle.position) else {
                continue;
            };
            particle.position -= distance * normal;
            let relative = particle.velocity - body.velocity_at(particle.position);
            particle.velocity -= relative.dot(normal).min(0.0) * normal;
            if particle.kind() == DiffuseKind::Spray {
                particle.lifetime = (particle.lifetime - foam_state.dt).max(0.0);
            }
        }
    });
}
