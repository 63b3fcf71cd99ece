use glam::Vec4Swizzles;

use super::UpdateBindings;
use crate::bodies::types::Body;
use crate::bodies::viscous::unknowns::{
    DIRECTION, IMAGE, PRODUCT, RESIDUAL, SOLUTION, VECTORS, by_impulse, get, plus, set,
};

pub(super) fn viscous_body_update(buffers: UpdateBindings<'_>) {
    let UpdateBindings { viscous, bodies, responses, unknowns, .. } = buffers;
    if viscous.stopped != 0 {
        return;
    }
    let rows = unknowns.chunks_exact_mut(VECTORS).zip(responses.as_chunks_mut::<2>().0);
    for (body, (own, response)) in bodies.iter().zip(rows) {
        if body.kind != Body::DYNAMIC {
            continue;
        }
        let direction = plus(response.map(|v| v.xyz()), viscous.beta, get(own, DIRECTION));
        let image = plus(get(own, PRODUCT), viscous.beta, get(own, IMAGE));
        let residual = plus(get(own, RESIDUAL), -viscous.alpha, image);
        let solution = plus(get(own, SOLUTION), viscous.alpha, direction);
        for (what, value) in
            [(DIRECTION, direction), (IMAGE, image), (RESIDUAL, residual), (SOLUTION, solution)]
        {
            set(own, what, value);
        }
        *response = by_impulse(body, residual).map(|v| v.extend(0.0));
    }
}
