#import sph/state
#import sph/viscous_state
#import sph/body
#import sph/body_algebra
#import sph/viscous_unknowns
#import sph/viscous_set_unknown

#bindings

@compute @workgroup_size(64)
fn viscous_body_update(@builtin(global_invocation_id) gid: vec3<u32>) {
    let b = gid.x;
    if (b >= arrayLength(&bodies) || viscous.stopped != 0u || state.run_count == 0u) {
        return;
    }
    if (bodies[b].kind != BODY_DYNAMIC) {
        return;
    }
    let z = BodyVelocities(responses[2u * b].xyz, responses[2u * b + 1u].xyz);
    let direction = plus(z, viscous.beta, unknown(b, UNKNOWN_DIRECTION));
    let image = plus(unknown(b, UNKNOWN_PRODUCT), viscous.beta, unknown(b, UNKNOWN_IMAGE));
    let residual = plus(unknown(b, UNKNOWN_RESIDUAL), -viscous.alpha, image);
    set_unknown(b, UNKNOWN_DIRECTION, direction);
    set_unknown(b, UNKNOWN_IMAGE, image);
    set_unknown(b, UNKNOWN_RESIDUAL, residual);
    set_unknown(b, UNKNOWN_SOLUTION, plus(unknown(b, UNKNOWN_SOLUTION), viscous.alpha, direction));
    let response = by_impulse(b, residual);
    responses[2u * b] = vec4(response.linear, 0.0);
    responses[2u * b + 1u] = vec4(response.angular, 0.0);
}
