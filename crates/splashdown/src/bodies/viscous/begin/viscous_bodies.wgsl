#import sph/params
#import sph/viscous_state
#import sph/body
#import sph/body_velocities
#import sph/viscous_unknowns
#import sph/viscous_set_unknown

#bindings

@compute @workgroup_size(64)
fn viscous_bodies(@builtin(global_invocation_id) gid: vec3<u32>) {
    let b = gid.x;
    // The step may be suspended.
    if (b >= arrayLength(&bodies) || viscous.stopped != 0u || state.run_count == 0u) {
        return;
    }
    let quantum = 1e-5 * params.particle_mass;
    let torque_quantum = quantum * params.support_radius;
    let word = SUM_WORDS * b;
    var other: array<f32, 6>;
    var friction: array<f32, 6>;
    for (var k = 0u; k < 6u; k++) {
        let at = word + 2u * k;
        other[k] = fixed_value(sums[at], sums[at + 1u]);
        friction[k] = fixed_value(pressure_sums[at], pressure_sums[at + 1u]);
        pressure_sums[at] = 0u;
        pressure_sums[at + 1u] = 0u;
    }
    let before = BodyVelocities(bodies[b].velocity, bodies[b].angular_velocity);
    let none = BodyVelocities(vec3(0.0), vec3(0.0));
    var residual = none;
    if (bodies[b].kind == BODY_DYNAMIC) {
        let next = next_velocities(
            b,
            quantum * vec3(other[0], other[1], other[2]),
            torque_quantum * vec3(other[3], other[4], other[5]),
        );
        let by_friction = BodyVelocities(
            quantum * vec3(friction[0], friction[1], friction[2]),
            torque_quantum * vec3(friction[3], friction[4], friction[5]),
        );
        residual = plus(impulse_of(b, plus(next, -1.0, before)), state.dt, by_friction);
    }
    set_unknown(b, UNKNOWN_DIRECTION, none);
    set_unknown(b, UNKNOWN_IMAGE, none);
    set_unknown(b, UNKNOWN_PRODUCT, none);
    set_unknown(b, UNKNOWN_RESIDUAL, residual);
    set_unknown(b, UNKNOWN_SOLUTION, before);
    let response = by_impulse(b, residual);
    responses[2u * b] = vec4(response.linear, 0.0);
    responses[2u * b + 1u] = vec4(response.angular, 0.0);
}
