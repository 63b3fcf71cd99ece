use super::PressureResponseBindings;
use crate::bodies::motion::next_velocities;
use crate::bodies::reaction::force_and_torque;
use crate::bodies::support::supported;
use crate::bodies::types::{Body, SUM_WORDS, SUPPORTS};

pub(super) fn pressure_response(buffers: PressureResponseBindings<'_>) {
    let PressureResponseBindings { params, state, solve, bodies, sums, pressure_sums, responses, supports } =
        buffers;
    if solve.stopped != 0 {
        return;
    }
    let both = sums.chunks_exact(SUM_WORDS).zip(pressure_sums.chunks_exact_mut(SUM_WORDS));
    let results = responses.as_chunks_mut::<2>().0.iter_mut().zip(supports.chunks_exact_mut(SUPPORTS));
    for ((body, (other, pressure)), (out, supports)) in bodies.iter().zip(both).zip(results) {
        let (first, second) = (force_and_torque(params, other), force_and_torque(params, pressure));
        pressure.fill(0);
        let mut next = [body.velocity, body.angular_velocity];
        if body.kind == Body::DYNAMIC {
            let free = next_velocities(params, state, body, [first[0] + second[0], first[1] + second[1]]);
            next = supported(body, supports, free);
        }
        *out = next.map(|v| v.extend(0.0));
    }
}
