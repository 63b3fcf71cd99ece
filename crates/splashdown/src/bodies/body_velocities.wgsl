// The motion of a dynamic body after a step; see motion. Needs `params`, `state` and `bodies`.
#import sph/body_algebra

struct NextMotion {
    velocities: BodyVelocities,
    orientation: vec4<f32>,
}

fn quaternion_product(a: vec4<f32>, b: vec4<f32>) -> vec4<f32> {
    return vec4(a.w * b.xyz + b.w * a.xyz + cross(a.xyz, b.xyz), a.w * b.w - dot(a.xyz, b.xyz));
}

// The rotation `q` followed by that of a rotation vector.
fn rotated_by(rotation_vector: vec3<f32>, q: vec4<f32>) -> vec4<f32> {
    let angle = length(rotation_vector);
    let axis = rotation_vector / max(angle, 1e-20);
    return normalize(quaternion_product(vec4(sin(0.5 * angle) * axis, cos(0.5 * angle)), q));
}

// The angular momentum of body `b` for an angular velocity.
fn angular_momentum_of(b: u32, spin: vec3<f32>) -> vec3<f32> {
    let q = bodies[b].orientation;
    return turned(q, symmetric(bodies[b].inertia, bodies[b].inertia_products) * turned_back(q, spin));
}

// The angular velocity of body `b` with this orientation and angular momentum.
fn spin_of(b: u32, q: vec4<f32>, angular_momentum: vec3<f32>) -> vec3<f32> {
    let inverse = symmetric(bodies[b].inverse_inertia, bodies[b].inverse_inertia_products);
    return turned(q, inverse * turned_back(q, angular_momentum));
}

// The angular momentum after the motor of a hinge has changed it, with at most its torque.
fn by_motor(b: u32, angular_momentum: vec3<f32>) -> vec3<f32> {
    let change = angular_momentum_of(b, bodies[b].motor) - angular_momentum;
    let most = bodies[b].motor_torque * state.dt;
    return angular_momentum + change * (most / max(max(length(change), most), 1e-30));
}

// The motion after a step with this force and torque.
fn next_motion(b: u32, force: vec3<f32>, fluid_torque: vec3<f32>) -> NextMotion {
    let dt = state.dt;
    let q = bodies[b].orientation;
    let gravity = body_acceleration(state.time);
    var velocity = bodies[b].velocity;
    // A hinged body has no inverse mass, and its hinge does not move.
    if (bodies[b].inverse_mass > 0.0) {
        velocity += dt * (force * bodies[b].inverse_mass + gravity);
    }
    let torque = fluid_torque + cross(turned(q, bodies[b].moment), gravity);
    let before = angular_momentum_of(b, bodies[b].angular_velocity);
    let angular_momentum = by_motor(b, before + dt * torque);
    let spin = spin_of(b, q, angular_momentum);
    let middle = rotated_by(0.5 * dt * spin, q);
    let orientation = rotated_by(dt * spin_of(b, middle, angular_momentum), q);
    // Sums of changes, so that rounding errors of the products do not add up over many steps.
    let by_torque = spin_of(b, q, angular_momentum - before);
    let by_rotation = spin_of(b, orientation, angular_momentum) - spin;
    return NextMotion(BodyVelocities(velocity, bodies[b].angular_velocity + by_torque + by_rotation), orientation);
}

// The velocities after a step with this force and torque.
fn next_velocities(b: u32, force: vec3<f32>, fluid_torque: vec3<f32>) -> BodyVelocities {
    return next_motion(b, force, fluid_torque).velocities;
}
