use glam::Vec3;

use super::BeginBindings;
use crate::bodies::motion::next_velocities;
use crate::bodies::reaction::force_and_torque;
use crate::bodies::types::{Body, SUM_WORDS};
use crate::bodies::viscous::unknowns::{
    DIRECTION, IMAGE, PRODUCT, RESIDUAL, SOLUTION, VECTORS, by_impulse, impulse_of, plus, set,
};

pub(super) fn viscous_bodies(buffers: BeginBindings<'_>) {
    let BeginBindings { params, state, viscous, bodies, sums, pressure_sums, responses, unknowns } = buffers;
    if viscous.stopped != 0 || state.run_count == 0 {
        return;
    }
    let rows = unknowns.chunks_exact_mut(VECTORS).zip(responses.as_chunks_mut::<2>().0);
    let forces = sums.chunks_exact(SUM_WORDS).zip(pressure_sums.chunks_exact_mut(SUM_WORDS));
    for ((body, (own, response)), (other, friction)) in bodies.iter().zip(rows).zip(forces) {
        let before = [body.velocity, body.angular_velocity];
        let mut residual = [Vec3::ZERO; 2];
        if body.kind == Body::DYNAMIC {
            let next = next_velocities(params, state, body, force_and_torque(params, other));
            let impulse = impulse_of(body, plus(next, -1.0, before));
            residual = plus(impulse, state.dt, force_and_torque(params, friction));
        }
        friction.fill(0);
        for what in [DIRECTION, IMAGE, PRODUCT] {
            set(own, what, [Vec3::ZERO; 2]);
        }
        set(own, RESIDUAL, residual);
        set(own, SOLUTION, before);
        *response = by_impulse(body, residual).map(|v| v.extend(0.0));
    }
}
