use glam::{Vec4, Vec4Swizzles};

use super::SumBindings;
use crate::bodies::reaction::force_and_torque;
use crate::bodies::types::{Body, SUM_WORDS};
use crate::bodies::viscous::unknowns::{PRODUCT, RESIDUAL, VECTORS, get, plus, product, set};

pub(super) fn viscous_sum(buffers: SumBindings<'_>) {
    let SumBindings { params, state, viscous, bodies, responses, pressure_sums, unknowns, residuals } =
        buffers;
    if viscous.stopped != 0 {
        return;
    }
    let mut total = Vec4::ZERO;
    let rows = unknowns.chunks_exact_mut(VECTORS).zip(responses.as_chunks::<2>().0);
    for ((body, (own, response)), friction) in
        bodies.iter().zip(rows).zip(pressure_sums.chunks_exact_mut(SUM_WORDS))
    {
        if body.kind != Body::DYNAMIC {
            continue;
        }
        let (r, z) = (get(own, RESIDUAL), response.map(|v| v.xyz()));
        let w = plus(r, -state.dt, force_and_torque(params, friction));
        friction.fill(0);
        set(own, PRODUCT, w);
        let (square, curvature) = (product(r, z), product(z, w));
        total += Vec4::new(square, curvature, square, 0.0) / params.particle_mass;
    }
    residuals[0] += total;
}
