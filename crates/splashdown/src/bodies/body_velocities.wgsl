// The velocities of a dynamic body after a step; see motion. Needs `params`, `state` and `bodies`.
#import sph/body_algebra

// The velocities after a step with this force and torque.
fn next_velocities(b: u32, force: vec3<f32>, fluid_torque: vec3<f32>) -> BodyVelocities {
    let dt = state.dt;
    let q = bodies[b].orientation;
    let gravity = body_acceleration(state.time);
    var velocity = bodies[b].velocity;
    // A hinged body has no inverse mass, and its hinge does not move.
    if (bodies[b].inverse_mass > 0.0) {
        velocity += dt * (force * bodies[b].inverse_mass + gravity);
    }
    let torque = fluid_torque + cross(turned(q, bodies[b].moment), gravity);
    let spin = turned_back(q, bodies[b].angular_velocity);
    let moment = turned_back(q, torque)
        - cross(spin, symmetric(bodies[b].inertia, bodies[b].inertia_products) * spin);
    let inverse = symmetric(bodies[b].inverse_inertia, bodies[b].inverse_inertia_products);
    return BodyVelocities(velocity, turned(q, spin + dt * (inverse * moment)));
}
