#import sph/params
#import sph/solve
#import sph/body
#import sph/body_velocities
#import sph/support

#bindings

// The sum of both kinds of forces; resets that of the pressure.
fn whole(word: u32) -> f32 {
    let value = fixed_value(sums[word], sums[word + 1u]) + fixed_value(pressure_sums[word], pressure_sums[word + 1u]);
    pressure_sums[word] = 0u;
    pressure_sums[word + 1u] = 0u;
    return value;
}

@compute @workgroup_size(64)
fn pressure_response(@builtin(global_invocation_id) gid: vec3<u32>) {
    let b = gid.x;
    if (b >= arrayLength(&bodies) || solve.stopped != 0u) {
        return;
    }
    let quantum = 1e-5 * params.particle_mass;
    let word = SUM_WORDS * b;
    let force = quantum * vec3(whole(word), whole(word + 2u), whole(word + 4u));
    let torque = quantum * params.support_radius * vec3(whole(word + 6u), whole(word + 8u), whole(word + 10u));
    var next = BodyVelocities(bodies[b].velocity, bodies[b].angular_velocity);
    if (bodies[b].kind == BODY_DYNAMIC) {
        next = supported(b, next_velocities(b, force, torque));
    }
    responses[2u * b] = vec4(next.linear, 0.0);
    responses[2u * b + 1u] = vec4(next.angular, 0.0);
}
