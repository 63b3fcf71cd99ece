// The part FORCES of the acceleration of a particle by its neighbours, the walls and body forces; see
// passes/acceleration. Needs `params`, `grid`, `state`, `cell_start`, `sorted_positions`, `sorted_velocities`,
// `densities`; a constant `HAS_TENSION`; and a function `tension_between`: the acceleration of particle i by surface
// tension with particle j, where d is x_i - x_j.
fn acceleration_of(i: u32, x: vec3<f32>, v: vec3<f32>, own: vec2<f32>) -> vec3<f32> {
    let rho = own.x;
    let pressure = own.y;
    let specific = pressure / (rho * rho);
    let body = body_acceleration(state.time);
    let cell = cell_of(x);

    let support = params.support_radius;
    let scale = 1.0 / support;
    let scale5 = scale * scale * scale * scale * scale;
    let reach = support * support;
    let soft = 0.01 * reach;
    let mass = params.particle_mass;
    let volume = mass / params.rest_density;
    let laminar = 10.0 * params.viscosity * volume;
    let artificial = params.artificial_viscosity * params.sound_speed * 0.5 * support * volume;
    let tension = HAS_TENSION && (FORCES & OTHER_FORCES) != 0u && params.surface_tension > 0.0;

    var a = vec3(0.0);
    for (var row = 0u; row < 9u; row++) {
        let range = row_range(cell, row);
        for (var j = range.x; j < range.y; j++) {
            let d = x - sorted_positions[j].xyz;
            let r2 = dot(d, d);
            if (r2 >= reach || j == i) {
                continue;
            }
            let q = sqrt(r2) * scale;
            let g = kernel_g(q) * scale5;
            let other = densities[j];
            let vx = dot(v - sorted_velocities[j].xyz, d);
            let viscous = vx / (r2 + soft) * (laminar + select(0.0, artificial, vx < 0.0));
            let pressure_sum = mass * (specific + other.y / (other.x * other.x));
            a += (g * (select(0.0, viscous, (FORCES & OTHER_FORCES) != 0u)
                - select(0.0, pressure_sum, (FORCES & PRESSURE_FORCE) != 0u))) * d;
            if (tension) {
                a += tension_between(i, j, d, q, rho, other.x);
            }
        }
    }

    let pressure_factor = params.rest_density * specific + pressure / params.rest_density;
    a = wall_acceleration(wall_terms(x), v, body, a, pressure_factor, state.dt);
    return a + select(vec3(0.0), body, (FORCES & OTHER_FORCES) != 0u);
}
