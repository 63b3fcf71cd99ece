use super::PressureResponseBindings;
use crate::bodies::motion::next_velocities;
use crate::bodies::reaction::force_and_torque;
use crate::bodies::types::{Body, SUM_WORDS};

pub(super) fn pressure_response(buffers: PressureResponseBindings<'_>) {
    let PressureResponseBindings { params, state, solve, bodies, sums, pressure_sums, responses } = buffers;
    if solve.stopped != 0 {
        return;
    }
    let both = sums.chunks_exact(SUM_WORDS).zip(pressure_sums.chunks_exact_mut(SUM_WORDS));
    for ((body, (other, pressure)), out) in bodies.iter().zip(both).zip(responses.as_chunks_mut::<2>().0) {
        let (first, second) = (force_and_torque(params, other), force_and_torque(params, pressure));
        pressure.fill(0);
        let mut next = [body.velocity, body.angular_velocity];
        if body.kind == Body::DYNAMIC {
            next = next_velocities(params, state, body, [first[0] + second[0], first[1] + second[1]]);
        }
        *out = next.map(|v| v.extend(0.0));
    }
}
