// What is round a point: the fluid's velocity there, and the number of its neighbours as if no wall cut the
// support.
struct Surroundings {
    velocity: vec3<f32>,
    neighbours: f32,
}

// The part of a ball's volume on this side of a plane at `distance` from its centre, in radii.
fn part_inside(distance: f32) -> f32 {
    let t = clamp(distance, 0.0, 1.0);
    return 0.5 + t * (0.75 - 0.25 * t * t);
}

fn surroundings(x: vec3<f32>) -> Surroundings {
    let scale = 1.0 / params.support_radius;
    let reach = params.support_radius * params.support_radius;
    let cell = cell_of(x);
    var found = 0.0;
    var sum = vec4(0.0);
    for (var row = 0u; row < 9u; row++) {
        let range = row_range(cell, row);
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
    var part = 1.0;
    for (var axis = 0u; axis < 3u; axis++) {
        if (((params.closed >> (2u * axis)) & 1u) == 1u) {
            part *= part_inside((x[axis] - params.domain_min[axis]) * scale);
        }
        if (((params.closed >> (2u * axis + 1u)) & 1u) == 1u) {
            part *= part_inside((params.domain_max[axis] - x[axis]) * scale);
        }
    }
    return Surroundings(sum.xyz / max(sum.w, 1e-20), found / part);
}

// Foam goes a little deeper before it is a bubble again, or it would be both by turns.
fn kind_of(neighbours: f32, was_foam: bool) -> u32 {
    if (neighbours < foam.spray_below) {
        return SPRAY;
    }
    let above = select(foam.bubble_above, foam.bubble_again_above, was_foam);
    return select(FOAM, BUBBLE, neighbours > above);
}
