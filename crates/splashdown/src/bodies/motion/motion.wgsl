#import sph/params
#import sph/step_counters
#import sph/body
#import sph/body_velocities

#bindings

// Converts a 64-bit sum to a float, and resets it.
fn taken(word: u32) -> f32 {
    let value = fixed_value(sums[word], sums[word + 1u]);
    sums[word] = 0u;
    sums[word + 1u] = 0u;
    return value;
}

fn by_force(b: u32) {
    let next = next_motion(b, bodies[b].force, bodies[b].torque);
    bodies[b].velocity = next.velocities.linear;
    bodies[b].angular_velocity = next.velocities.angular;
    bodies[b].position += state.dt * bodies[b].velocity;
    bodies[b].orientation = next.orientation;
}

fn by_script(b: u32) {
    // The time at the end of this step, in samples since the start of the frame.
    let done = 1.0 - (state.remaining - state.dt) / state.frame_duration;
    let at = clamp(done, 0.0, 1.0) * f32(SCRIPT_SAMPLES - 1u);
    let k = min(u32(at), SCRIPT_SAMPLES - 2u);
    let f = at - f32(k);
    let one = scripts[bodies[b].script * SCRIPT_SAMPLES + k];
    let two = scripts[bodies[b].script * SCRIPT_SAMPLES + k + 1u];
    let length = state.frame_duration / f32(SCRIPT_SAMPLES - 1u);
    let f2 = f * f;
    let f3 = f2 * f;
    bodies[b].position = (2.0 * f3 - 3.0 * f2 + 1.0) * one.position + (f3 - 2.0 * f2 + f) * length * one.velocity
        + (3.0 * f2 - 2.0 * f3) * two.position + (f3 - f2) * length * two.velocity;
    let near = select(-two.orientation, two.orientation, dot(one.orientation, two.orientation) >= 0.0);
    bodies[b].orientation = normalize(mix(one.orientation, near, f));
    bodies[b].velocity = mix(one.velocity, two.velocity, f);
    bodies[b].angular_velocity = mix(one.angular_velocity, two.angular_velocity, f);
}

@compute @workgroup_size(64)
fn motion(@builtin(global_invocation_id) gid: vec3<u32>) {
    let b = gid.x;
    if (b >= arrayLength(&bodies) || state.run_count == 0u) {
        return;
    }
    let quantum = 1e-5 * params.particle_mass;
    let word = SUM_WORDS * b;
    bodies[b].force = quantum * vec3(taken(word), taken(word + 2u), taken(word + 4u));
    let torque = vec3(taken(word + 6u), taken(word + 8u), taken(word + 10u));
    bodies[b].torque = quantum * params.support_radius * torque;
    let velocity = bodies[b].velocity;
    let spin = bodies[b].angular_velocity;
    if (bodies[b].kind == BODY_DYNAMIC) {
        by_force(b);
    } else if (bodies[b].kind == BODY_SCRIPTED) {
        by_script(b);
    } else {
        return;
    }
    // The force on the fluid is opposite; the mean of the velocities before and after the step makes the work of a dynamic
    // body the change of its kinetic energy.
    let power = dot(bodies[b].force, velocity + bodies[b].velocity)
        + dot(bodies[b].torque, spin + bodies[b].angular_velocity);
    bodies[b].work -= 0.5 * state.dt * power;
    // The collisions hold a body with supports.
    let is_held = any(supports[SUPPORTS * b].normal != vec3(0.0));
    let speed = length(select(bodies[b].velocity, velocity, is_held))
        + bodies[b].reach * length(select(bodies[b].angular_velocity, spin, is_held));
    atomicMax(&counters[COUNTER_MAX_SPEED], bitcast<u32>(speed));
}
