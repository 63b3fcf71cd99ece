use glam::{Quat, Vec3, Vec4};

use super::MotionBindings;
use crate::bodies::boundary_force::quantum;
use crate::bodies::types::{Body, SCRIPT_SAMPLES, SUM_WORDS, ScriptSample};
use crate::state::{Params, StepCounters, StepState};

pub(super) fn motion(buffers: MotionBindings<'_>) {
    let MotionBindings { params, state, scripts, bodies, sums, counters } = buffers;
    if state.run_count == 0 {
        return;
    }
    let sums = sums.chunks_exact_mut(SUM_WORDS);
    for (body, sums) in bodies.iter_mut().zip(sums) {
        let quantum = quantum(params);
        let [force, torque] = [0, 6].map(|first| {
            let sums = &sums[first..first + 6];
            Vec3::new(value(sums, 0), value(sums, 2), value(sums, 4))
        });
        sums.fill(0);
        body.force = quantum * force;
        body.torque = quantum * params.support_radius * torque;
        match body.kind {
            Body::DYNAMIC => by_force(params, state, body),
            Body::SCRIPTED => by_script(state, &scripts[body.script as usize * SCRIPT_SAMPLES..], body),
            _ => continue,
        }
        let speed = body.velocity.length() + body.reach * body.angular_velocity.length();
        let word = &mut counters[StepCounters::MAX_SPEED];
        *word = (*word).max(speed.to_bits());
    }
}

/// Converts a 64-bit sum to a float, with the rounding of the GPU: half by half. The sign is separated first, because
/// the halves of a small negative number are large.
fn value(words: &[u32], first: usize) -> f32 {
    let sum = (u64::from(words[first]) | u64::from(words[first + 1]) << 32).cast_signed();
    let size = sum.unsigned_abs();
    let value = (size >> 32) as f32 * 4_294_967_296.0 + size as u32 as f32;
    if sum < 0 { -value } else { value }
}

fn by_force(params: &Params, state: &StepState, body: &mut Body) {
    let dt = state.dt;
    let q = body.rotation();
    let gravity = params.body_acceleration(state.time);
    // A hinged body has no inverse mass, and its hinge does not move.
    if body.inverse_mass > 0.0 {
        body.velocity += dt * (body.force * body.inverse_mass + gravity);
    }
    let torque = body.torque + (q * body.moment).cross(gravity);
    let spin = q.conjugate() * body.angular_velocity;
    let moment = q.conjugate() * torque - spin.cross(body.inertia_matrix() * spin);
    let spin = q * (spin + dt * (body.inverse_inertia_matrix() * moment));
    body.angular_velocity = spin;
    body.position += dt * body.velocity;
    let turn = Quat::from_scaled_axis(spin * dt);
    body.orientation = Vec4::from((turn * q).normalize());
}

fn by_script(state: &StepState, samples: &[ScriptSample], body: &mut Body) {
    // The time at the end of this step, in samples since the start of the frame.
    let done = 1.0 - (state.remaining - state.dt) / state.frame_duration;
    let at = done.clamp(0.0, 1.0) * (SCRIPT_SAMPLES - 1) as f32;
    let k = (at as usize).min(SCRIPT_SAMPLES - 2);
    let f = at - k as f32;
    let (one, two) = (&samples[k], &samples[k + 1]);
    let length = state.frame_duration / (SCRIPT_SAMPLES - 1) as f32;
    let (f2, f3) = (f * f, f * f * f);
    body.position = (2.0 * f3 - 3.0 * f2 + 1.0) * one.position
        + (f3 - 2.0 * f2 + f) * length * one.velocity
        + (3.0 * f2 - 2.0 * f3) * two.position
        + (f3 - f2) * length * two.velocity;
    let near = if one.orientation.dot(two.orientation) >= 0.0 { two.orientation } else { -two.orientation };
    body.orientation = one.orientation.lerp(near, f).normalize_or(one.orientation);
    body.velocity = one.velocity.lerp(two.velocity, f);
    body.angular_velocity = one.angular_velocity.lerp(two.angular_velocity, f);
}
