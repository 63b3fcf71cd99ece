#import sph/params
#import sph/step_counters
#import sph/body

#bindings

// Converts a 64-bit sum to a float, and resets it. The sign is separated first, because the halves of a small negative
// number are large.
fn taken(word: u32) -> f32 {
    var low = sums[word];
    var high = sums[word + 1u];
    sums[word] = 0u;
    sums[word + 1u] = 0u;
    let negative = (high >> 31u) == 1u;
    if (negative) {
        low = ~low + 1u;
        high = ~high + select(0u, 1u, low == 0u);
    }
    let value = f32(high) * 4294967296.0 + f32(low);
    return select(value, -value, negative);
}

fn symmetric(d: vec3<f32>, p: vec3<f32>) -> mat3x3<f32> {
    return mat3x3(vec3(d.x, p.x, p.y), vec3(p.x, d.y, p.z), vec3(p.y, p.z, d.z));
}

fn product(a: vec4<f32>, b: vec4<f32>) -> vec4<f32> {
    return vec4(a.w * b.xyz + b.w * a.xyz + cross(a.xyz, b.xyz), a.w * b.w - dot(a.xyz, b.xyz));
}

fn by_force(b: u32) {
    let dt = state.dt;
    let q = bodies[b].orientation;
    let gravity = body_acceleration(state.time);
    // A hinged body has no inverse mass, and its hinge does not move.
    if (bodies[b].inverse_mass > 0.0) {
        bodies[b].velocity += dt * (bodies[b].force * bodies[b].inverse_mass + gravity);
    }
    let torque = bodies[b].torque + cross(turned(q, bodies[b].moment), gravity);
    let spin = turned_back(q, bodies[b].angular_velocity);
    let moment = turned_back(q, torque)
        - cross(spin, symmetric(bodies[b].inertia, bodies[b].inertia_products) * spin);
    let inverse = symmetric(bodies[b].inverse_inertia, bodies[b].inverse_inertia_products);
    let next_spin = turned(q, spin + dt * (inverse * moment));
    bodies[b].angular_velocity = next_spin;
    bodies[b].position += dt * bodies[b].velocity;
    let angle = length(next_spin) * dt;
    let axis = next_spin / max(length(next_spin), 1e-20);
    let turn = vec4(sin(0.5 * angle) * axis, cos(0.5 * angle));
    bodies[b].orientation = normalize(product(turn, q));
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
    if (bodies[b].kind == BODY_DYNAMIC) {
        by_force(b);
    } else if (bodies[b].kind == BODY_SCRIPTED) {
        by_script(b);
    } else {
        return;
    }
    let speed = length(bodies[b].velocity) + bodies[b].reach * length(bodies[b].angular_velocity);
    atomicMax(&counters[COUNTER_MAX_SPEED], bitcast<u32>(speed));
}
