// The velocities that the contacts of body `b` with solids allow; see support.rs. Needs `bodies` and `supports`.
#import sph/body_algebra
#import sph/body_velocities

const SUPPORT_SWEEPS: u32 = 16u;

fn supported(b: u32, free: BodyVelocities) -> BodyVelocities {
    var next = free;
    let first = SUPPORTS * b;
    var count = 0u;
    while (count < SUPPORTS && any(supports[first + count].normal != vec3(0.0))) {
        supports[first + count].impulse = 0.0;
        count += 1u;
    }
    let q = bodies[b].orientation;
    let inverse_mass = bodies[b].inverse_mass;
    var has_changed = count > 0u;
    for (var sweep = 0u; sweep < SUPPORT_SWEEPS && has_changed; sweep += 1u) {
        has_changed = false;
        for (var s = first; s < first + count; s += 1u) {
            let normal = supports[s].normal;
            let lever = cross(supports[s].arm, normal);
            let spin = spin_of(b, q, lever);
            let response = inverse_mass + dot(lever, spin);
            if (response > 0.0) {
                let approach = supports[s].min_speed - dot(normal, next.linear) - dot(lever, next.angular);
                let before = supports[s].impulse;
                let after = max(before + approach / response, 0.0);
                supports[s].impulse = after;
                has_changed |= after != before;
                next.linear += (after - before) * inverse_mass * normal;
                next.angular += (after - before) * spin;
            }
        }
    }
    return next;
}
