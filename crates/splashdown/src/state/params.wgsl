#import sph/state
// Mirrors Params in params.rs.
struct Params {
    gravity: vec3<f32>,
    support_radius: f32,
    domain_min: vec3<f32>,
    particle_spacing: f32,
    domain_max: vec3<f32>,
    particle_mass: f32,
    oscillation: vec3<f32>,
    oscillation_rate: f32,
    rest_density: f32,
    sound_speed: f32,
    solid_offset: f32,
    exponent: f32,
    viscosity: f32,
    artificial_viscosity: f32,
    density_diffusion: f32,
    surface_tension: f32,
    wall_friction: f32,
    cfl_factor: f32,
    max_dt: f32,
    min_dt: f32,
    closed: u32,
    clamp_pressure: u32,
    particle_count: u32,
    approach_damping_factor: f32,
    summed_mass: f32,
    inverse_kernel_at_spacing: f32,
    boundary_viscosity: f32,
    is_implicit: u32,
    tolerance: f32,
    max_iterations: u32,
    longest_motion: f32,
    pressure_factor: f32,
    implicit_viscosity: f32,
    viscous_factor: f32,
    viscous_tolerance: f32,
    most_viscous_iterations: u32,
    tension_factor: f32,
    largest_curvature: f32,
    interface_depth: f32,
    weakest_normal: f32,
    wetting: f32,
    relaxation: f32,
    compressibility: f32,
    surface_completion: f32,
    solid_stretch: f32,
    slope_offset: f32,
    background_pressure: f32,
    lattice_moment: f32,
    accepted_excess: f32,
    motion_stiffness: f32,
    unused: vec2<f32>,
}

// See SolveState::is_measuring.
fn is_measuring(iteration: u32) -> bool {
    return params.accepted_excess > 0.0 && iteration == 0u;
}

// See Params::compressibility_in.
fn compressibility_in(state: StepState) -> f32 {
    if (params.motion_stiffness == 0.0) {
        return params.compressibility;
    }
    let slowest = 0.01 * params.particle_spacing / state.dt;
    let speed = max(max(state.max_speed, state.body_speed), slowest);
    let stiffness = params.motion_stiffness * speed * speed;
    if (params.compressibility > 0.0) {
        return params.compressibility / (1.0 + params.compressibility * stiffness);
    }
    return 1.0 / stiffness;
}

// See Params::tension_limit.
fn tension_limit() -> f32 {
    return select(2.0 * length(params.gravity) * params.particle_spacing, 0.0, params.clamp_pressure == 1u);
}

// See Params::closing_rate.
fn closing_rate() -> f32 {
    return sqrt(2.0 * length(params.gravity) / params.particle_spacing);
}

fn pressure_at(density: f32) -> f32 {
    let x = density / params.rest_density;
    let stiffness = params.rest_density * params.sound_speed * params.sound_speed / params.exponent;
    var p: f32;
    if (params.exponent == 7.0) {
        let x2 = x * x;
        p = stiffness * (x2 * x2 * x2 * x - 1.0);
    } else if (params.exponent == 1.0) {
        p = stiffness * (x - 1.0);
    } else {
        p = stiffness * (pow(x, params.exponent) - 1.0);
    }
    return select(p, max(p, 0.0), params.clamp_pressure == 1u) + params.background_pressure;
}

// See Params::bounded_density.
fn bounded_density(density: f32) -> f32 {
    let is_number = (bitcast<u32>(density) & 0x7f800000u) != 0x7f800000u;
    return select(density, 1.35 * params.rest_density, is_number && density > 1.35 * params.rest_density);
}

// The length of the next step; see Params::step_length.
fn step_length(stable: f32, remaining: f32, is_first: bool) -> f32 {
    if (params.is_implicit == 1u) {
        let steps = ceil(remaining / (select(1.05, 1.0001, is_first) * stable));
        return select(remaining / steps, remaining, steps <= 1.0);
    }
    if (remaining >= 2.0 * stable) {
        return stable;
    }
    return select(0.5 * remaining, remaining, remaining <= stable);
}

// The longest stable step without the limit by the implicit pressure; see Params::longest_step.
fn longest_step(speed: f32, acceleration: f32, excess: f32) -> f32 {
    let h = 0.5 * params.support_radius;
    let c = params.cfl_factor;
    var longest = min(params.max_dt, 0.125 * h * h / max(params.viscosity, 1e-20));
    if (params.is_implicit == 1u) {
        return min(longest, c * params.particle_spacing / max(speed, 1e-20));
    }
    longest = min(longest, c * h / (params.sound_speed + speed));
    let compressed = params.sound_speed * pow(1.0 + excess, 0.5 * (params.exponent - 1.0));
    longest = min(longest, max(c, 0.9) * h / (compressed + speed));
    longest = min(longest, c * sqrt(h / max(acceleration, 1e-20)));
    longest = min(longest, c * 0.4 * params.particle_spacing / max(speed, 1e-20));
    return min(longest, 0.17 * h / max(params.density_diffusion * params.sound_speed, 1e-20));
}

fn body_acceleration(time: f32) -> vec3<f32> {
    return params.gravity + params.oscillation * sin(params.oscillation_rate * time);
}
