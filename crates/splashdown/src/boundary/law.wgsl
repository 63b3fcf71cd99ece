// The forces of a wall or a body on a particle, apart from pressure; see law.rs. Needs `params`.

// The selected part of the forces: PRESSURE_FORCE, OTHER_FORCES or both.
override FORCES: u32 = 3u;
const PRESSURE_FORCE: u32 = 1u;
const OTHER_FORCES: u32 = 2u;

const BOUNDARY_CLEARANCE: f32 = 0.25;

fn approach_damping(q: f32) -> f32 {
    let scale = 1.0 / params.support_radius;
    let t = 1.0 - q;
    return params.approach_damping_factor * 7.0 * params.sound_speed * scale * t * t * t * t * t * (1.0 + 2.0 * q);
}

fn boundary_friction(friction: f32, viscosity: f32, gradient: f32, distance: f32) -> f32 {
    return friction * 2.0 * viscosity * gradient / max(distance, BOUNDARY_CLEARANCE * params.particle_spacing);
}

fn implicit_rate(k: f32, dt: f32) -> f32 {
    return k / (1.0 + k * dt);
}

fn yielding(coupling: f32) -> f32 {
    return 1.0 + BOUNDARY_CLEARANCE * params.rest_density * params.particle_spacing * coupling;
}

fn contact_speed(distance: f32, dt: f32) -> f32 {
    return max(distance - BOUNDARY_CLEARANCE * params.particle_spacing, 0.0) / dt;
}
