// The fluid at a point: its velocity, and the number of neighbours, corrected for the part of the
// support that walls cut off.
struct Ambient {
    velocity: vec3<f32>,
    neighbours: f32,
}

// The fraction of the volume of a ball on this side of a plane at `distance` from its centre, in
// radii.
fn ball_fraction(distance: f32) -> f32 {
    let t = clamp(distance, 0.0, 1.0);
    return 0.5 + t * (0.75 - 0.25 * t * t);
}

fn ambient(x: vec3<f32>) -> Ambient {
    let scale = 1.0 / params.support_radius;
    let reach = params.support_radius * params.support_radius;
    let rows = rows_around(x);
    var found = 0.0;
    var sum = vec4(0.0);
    for (var row = 0u; row < 9u; row++) {
        let range = row_range(rows, row);
        for (var j = range.x; j < range.y; j++) {
            let d = x - sorted_positions[j].xyz;
            let r2 = dot(d, d);
            if (r2 < reach) {
                let w = kernel_w(sqrt(r2) * scale);
                sum += w * vec4(sorted_velocities[j].xyz, 1.0);
                found += 1.0;
            }
        }
    }
    var fraction = 1.0;
    for (var axis = 0u; axis < 3u; axis++) {
        if (((params.closed >> (2u * axis)) & 1u) == 1u) {
            fraction *= ball_fraction((x[axis] - params.domain_min[axis]) * scale);
        }
        if (((params.closed >> (2u * axis + 1u)) & 1u) == 1u) {
            fraction *= ball_fraction((params.domain_max[axis] - x[axis]) * scale);
        }
    }
    return Ambient(sum.xyz / max(sum.w, 1e-20), found / fraction);
}

// Hysteresis: the limit at which foam becomes a bubble is higher, which prevents flickering between
// the two.
fn kind_of(neighbours: f32, was_foam: bool) -> u32 {
    if (neighbours < foam.spray_below) {
        return SPRAY;
    }
    let above = select(foam.bubble_above, foam.bubble_again_above, was_foam);
    return select(FOAM, BUBBLE, neighbours > above);
}
