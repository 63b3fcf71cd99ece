// The part FORCES of the acceleration of a particle by its neighbours, the walls and body forces; see
// passes/acceleration. Needs sph/candidates, `params`, `grid`, `state`, `cell_start`, `sorted_positions`, `sorted_velocities`,
// `densities`; a constant `HAS_TENSION`; and a function `tension_between`: the acceleration of particle i by surface
// tension with the image of particle j that has the reflection `sign`, where d is the distance from the image.
fn acceleration_of(i: u32, x: vec3<f32>, v: vec3<f32>, own: vec2<f32>) -> vec3<f32> {
    let rho = own.x;
    let pressure = own.y;
    let specific = pressure / (rho * rho);
    let body = body_acceleration(state.time);

    let support = params.support_radius;
    let scale = 1.0 / support;
    let scale5 = scale * scale * scale * scale * scale;
    let soft = 0.01 * support * support;
    let mass = params.summed_mass;
    let volume = mass / params.rest_density;
    let laminar = 10.0 * params.viscosity * volume;
    let artificial = params.artificial_viscosity * params.sound_speed * 0.5 * support * volume;
    let tension = HAS_TENSION && (FORCES & OTHER_FORCES) != 0u && params.surface_tension > 0.0;

    var a = vec3(0.0);
    for (var left = reflections_near(x); left != 0u; left &= left - 1u) {
        let by = reflection(firstTrailingBit(left));
        let own_x = reflected_point(by, x);
        let own_v = by.sign * v;
        // The hydrostatic difference between an image and its particle is linear in the particle's position.
        let slope = (by.sign - 1.0) * body / params.rest_density;
        let offset = dot(by.shift, body) / params.rest_density;
        a *= by.sign;
        let rows = rows_of_image(x, own_x);
        for (var row = 0u; row < 9u; row++) {
            let range = row_range(rows, row);
            for (var first = range.x; first < range.y; first += CANDIDATES) {
                for (var bits = neighbour_bits(own_x, first, range.y); bits != 0u; bits &= bits - 1u) {
                    let j = first + firstTrailingBit(bits);
                    let p = sorted_positions[j].xyz;
                    let d = own_x - p;
                    let r2 = dot(d, d);
                    let q = sqrt(r2) * scale;
                    let g = kernel_g(q) * scale5;
                    let other = densities[j];
                    let vx = dot(own_v - sorted_velocities[j].xyz, d);
                    let viscous = vx / (r2 + soft) * (laminar + select(0.0, artificial, vx < 0.0));
                    let own = other.y / (other.x * other.x);
                    let more = offset + dot(slope, p);
                    let pressure_sum = mass * (specific + extrapolated(own, more));
                    a += (g * (select(0.0, viscous, (FORCES & OTHER_FORCES) != 0u)
                        - select(0.0, pressure_sum, (FORCES & PRESSURE_FORCE) != 0u))) * d;
                    if (tension) {
                        a += by.sign * tension_between(i, j, by.sign, by.sign * d, q, rho, other.x);
                    }
                }
            }
        }
        a *= by.sign;
    }

    if ((FORCES & OTHER_FORCES) != 0u) {
        a += body + wall_friction(x, v, state.dt);
    }
    return a;
}
