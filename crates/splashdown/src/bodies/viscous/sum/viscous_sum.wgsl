#import sph/params
#import sph/viscous_state
#import sph/body
#import sph/body_algebra
#import sph/viscous_unknowns
#import sph/viscous_set_unknown

#bindings

// Converts a 64-bit sum to a float, and resets it.
fn taken(word: u32) -> f32 {
    let value = fixed_value(pressure_sums[word], pressure_sums[word + 1u]);
    pressure_sums[word] = 0u;
    pressure_sums[word + 1u] = 0u;
    return value;
}

@compute @workgroup_size(1)
fn viscous_sum() {
    if (viscous.stopped != 0u || state.run_count == 0u) {
        return;
    }
    let quantum = 1e-5 * params.particle_mass;
    var total = vec4(0.0);
    for (var b = 0u; b < arrayLength(&bodies); b++) {
        if (bodies[b].kind != BODY_DYNAMIC) {
            continue;
        }
        let word = SUM_WORDS * b;
        let force = quantum * vec3(taken(word), taken(word + 2u), taken(word + 4u));
        let torque = quantum * params.support_radius * vec3(taken(word + 6u), taken(word + 8u), taken(word + 10u));
        let r = unknown(b, UNKNOWN_RESIDUAL);
        let z = BodyVelocities(responses[2u * b].xyz, responses[2u * b + 1u].xyz);
        let w = plus(r, -state.dt, BodyVelocities(force, torque));
        set_unknown(b, UNKNOWN_PRODUCT, w);
        let square = both_products(r, z);
        total += vec4(square, both_products(z, w), square, 0.0) / params.particle_mass;
    }
    residuals[0] += total;
}
