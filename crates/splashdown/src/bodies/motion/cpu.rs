use glam::{Quat, Vec3, Vec4};

use super::MotionBindings;
use crate::bodies::reaction;
use crate::bodies::types::{Body, SCRIPT_SAMPLES, SUM_WORDS, SUPPORTS, ScriptSample};
use crate::state::{Params, StepCounters, StepState};

pub(super) fn motion(buffers: MotionBindings<'_>) {
    let MotionBindings { params, state, scripts, supports, bodies, sums, counters } = buffers;
    if state.run_count == 0 {
        return;
    }
    let each = sums.chunks_exact_mut(SUM_WORDS).zip(supports.chunks_exact(SUPPORTS));
    for (body, (sums, supports)) in bodies.iter_mut().zip(each) {
        [body.force, body.torque] = reaction::force_and_torque(params, sums);
        sums.fill(0);
        let (velocity, spin) = (body.velocity, body.angular_velocity);
        match body.kind {
            Body::DYNAMIC => by_force(params, state, body),
            Body::SCRIPTED => by_script(state, &scripts[body.script as usize * SCRIPT_SAMPLES..], body),
            _ => continue,
        }
        // The force on the fluid is opposite; the mean of the velocities before and after the step makes the work of a
        // dynamic body the change of its kinetic energy.
        let power = body.force.dot(velocity + body.velocity) + body.torque.dot(spin + body.angular_velocity);
        body.work -= 0.5 * state.dt * power;
        // The collisions hold a body with supports.
        let is_held = supports[0].normal != Vec3::ZERO;
        let [velocity, spin] =
            if is_held { [velocity, spin] } else { [body.velocity, body.angular_velocity] };
        let speed = velocity.length() + body.reach * spin.length();
        let word = &mut counters[StepCounters::MAX_SPEED];
        *word = (*word).max(speed.to_bits());
    }
}

/// The velocity and the angular velocity of a dynamic body after a step with this force and torque.
pub(in crate::bodies) fn next_velocities(
    params: &Params,
    state: &StepState,
    body: &Body,
    force_and_torque: [Vec3; 2],
) -> [Vec3; 2] {
    let next = after(params, state, body, force_and_torque);
    [next.velocity, next.angular_velocity]
}

/// The motion of a dynamic body after a step.
struct Next {
    velocity: Vec3,
    angular_velocity: Vec3,
    orientation: Quat,
}

fn after(params: &Params, state: &StepState, body: &Body, [force, torque]: [Vec3; 2]) -> Next {
    let dt = state.dt;
    let q = body.rotation();
    let gravity = params.body_acceleration(state.time);
    let mut velocity = body.velocity;
    // A hinged body has no inverse mass, and its hinge does not move.
    if body.inverse_mass > 0.0 {
        velocity += dt * (force * body.inverse_mass + gravity);
    }
    let torque = torque + (q * body.moment).cross(gravity);
    let inertia = |w: Vec3| q * (body.inertia_matrix() * (q.conjugate() * w));
    let spin_of = |q: Quat, l: Vec3| q * (body.inverse_inertia_matrix() * (q.conjugate() * l));
    let before = inertia(body.angular_velocity);
    let angular_momentum = by_motor(body, dt, before + dt * torque, inertia(body.motor));
    let turned = |dt: f32, spin: Vec3| (Quat::from_scaled_axis(dt * spin) * q).normalize();
    let spin = spin_of(q, angular_momentum);
    let middle = turned(0.5 * dt, spin);
    let orientation = turned(dt, spin_of(middle, angular_momentum));
    // Sums of changes, so that rounding errors of the products do not add up over many steps.
    let by_torque = spin_of(q, angular_momentum - before);
    let by_rotation = spin_of(orientation, angular_momentum) - spin;
    Next { velocity, angular_velocity: body.angular_velocity + by_torque + by_rotation, orientation }
}

/// The angular momentum after the motor of a hinge has changed it towards `wanted`, with at most its torque.
fn by_motor(body: &Body, dt: f32, angular_momentum: Vec3, wanted: Vec3) -> Vec3 {
    angular_momentum + (wanted - angular_momentum).clamp_length_max(body.motor_torque * dt)
}

fn by_force(params: &Params, state: &StepState, body: &mut Body) {
    let next = after(params, state, body, [body.force, body.torque]);
    body.velocity = next.velocity;
    body.angular_velocity = next.angular_velocity;
    body.position += state.dt * body.velocity;
    body.orientation = Vec4::from(next.orientation);
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
