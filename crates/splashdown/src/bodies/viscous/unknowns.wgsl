// The unknowns of dynamic bodies in the implicit viscosity; see unknowns.rs. Needs `bodies` and `unknowns`, and imports
// sph/body_algebra.
const UNKNOWNS: u32 = 10u;
const UNKNOWN_RESIDUAL: u32 = 0u;
const UNKNOWN_DIRECTION: u32 = 2u;
const UNKNOWN_IMAGE: u32 = 4u;
const UNKNOWN_SOLUTION: u32 = 6u;
const UNKNOWN_PRODUCT: u32 = 8u;

fn unknown(b: u32, what: u32) -> BodyVelocities {
    return BodyVelocities(unknowns[UNKNOWNS * b + what].xyz, unknowns[UNKNOWNS * b + what + 1u].xyz);
}

fn by_impulse(b: u32, impulse: BodyVelocities) -> BodyVelocities {
    let q = bodies[b].orientation;
    let inverse = symmetric(bodies[b].inverse_inertia, bodies[b].inverse_inertia_products);
    return BodyVelocities(
        bodies[b].inverse_mass * impulse.linear,
        turned(q, inverse * turned_back(q, impulse.angular)),
    );
}

fn impulse_of(b: u32, velocities: BodyVelocities) -> BodyVelocities {
    let q = bodies[b].orientation;
    let inertia = symmetric(bodies[b].inertia, bodies[b].inertia_products);
    var linear = vec3(0.0);
    if (bodies[b].inverse_mass > 0.0) {
        linear = velocities.linear / bodies[b].inverse_mass;
    }
    return BodyVelocities(linear, turned(q, inertia * turned_back(q, velocities.angular)));
}

fn both_products(a: BodyVelocities, b: BodyVelocities) -> f32 {
    return dot(a.linear, b.linear) + dot(a.angular, b.angular);
}

fn plus(a: BodyVelocities, factor: f32, b: BodyVelocities) -> BodyVelocities {
    return BodyVelocities(a.linear + factor * b.linear, a.angular + factor * b.angular);
}
