// Interpolation of the maps of bodies; see field.rs. The pass binds `bodies` and `maps`.

// The map at a point of the mesh's frame: distance, effective distance and their gradients.
struct Field {
    distance: f32,
    effective: f32,
    distance_gradient: vec3<f32>,
    effective_gradient: vec3<f32>,
}

// A point of the world in the frame of the mesh of a body.
fn body_point(b: u32, x: vec3<f32>) -> vec3<f32> {
    return turned_back(bodies[b].orientation, x - bodies[b].position) + bodies[b].center;
}

// Whether the map of a body contains a point of the mesh's frame.
fn is_in_map(b: u32, y: vec3<f32>) -> bool {
    let cells = vec3<f32>(vec3(bodies[b].nodes_x, bodies[b].nodes_y, bodies[b].nodes_z) - vec3(1u));
    let high = bodies[b].field_min + cells * bodies[b].cell_size;
    return all(y > bodies[b].field_min) && all(y < high);
}

fn field_at(b: u32, y: vec3<f32>) -> Field {
    let size = vec3(bodies[b].nodes_x, bodies[b].nodes_y, bodies[b].nodes_z);
    let inverse = 1.0 / bodies[b].cell_size;
    let at = (y - bodies[b].field_min) * inverse;
    let cell = min(vec3<u32>(at), size - vec3(2u));
    let f = at - vec3<f32>(cell);
    let row = size.x;
    let plane = size.x * size.y;
    let first = bodies[b].first_node + cell.z * plane + cell.y * row + cell.x;
    let c000 = maps[first];
    let c100 = maps[first + 1u];
    let c010 = maps[first + row];
    let c110 = maps[first + row + 1u];
    let c001 = maps[first + plane];
    let c101 = maps[first + plane + 1u];
    let c011 = maps[first + plane + row];
    let c111 = maps[first + plane + row + 1u];
    let x00 = mix(c000, c100, f.x);
    let x10 = mix(c010, c110, f.x);
    let x01 = mix(c001, c101, f.x);
    let x11 = mix(c011, c111, f.x);
    let y0 = mix(x00, x10, f.y);
    let y1 = mix(x01, x11, f.y);
    let value = mix(y0, y1, f.z);
    let dx = mix(mix(c100 - c000, c110 - c010, f.y), mix(c101 - c001, c111 - c011, f.y), f.z) * inverse;
    let dy = mix(x10 - x00, x11 - x01, f.z) * inverse;
    let dz = (y1 - y0) * inverse;
    return Field(value.x, value.y, vec3(dx.x, dy.x, dz.x), vec3(dx.y, dy.y, dz.y));
}

// The effective distance at a point of the mesh's frame inside the map (w), and its gradient (xyz), by a quadratic B-spline; see
// solid/spline.rs.
fn effective_at(b: u32, y: vec3<f32>) -> vec4<f32> {
    let size = vec3(bodies[b].nodes_x, bodies[b].nodes_y, bodies[b].nodes_z);
    let inverse = 1.0 / bodies[b].cell_size;
    let at = (y - bodies[b].field_min) * inverse;
    let center = clamp(vec3<u32>(at + 0.5), vec3(1u), size - vec3(2u));
    let g = at - vec3<f32>(center);
    let before = 0.5 - g;
    let after = 0.5 + g;
    let first_weights = 0.5 * before * before;
    let middle_weights = 0.75 - g * g;
    let last_weights = 0.5 * after * after;
    let x_weights = vec3(first_weights.x, middle_weights.x, last_weights.x);
    let x_slopes = vec3(-before.x, -2.0 * g.x, after.x);
    let y_weights = vec3(first_weights.y, middle_weights.y, last_weights.y);
    let y_slopes = vec3(-before.y, -2.0 * g.y, after.y);
    let z_weights = vec3(first_weights.z, middle_weights.z, last_weights.z);
    let z_slopes = vec3(-before.z, -2.0 * g.z, after.z);
    let row = size.x;
    let plane = size.x * size.y;
    let first =
        bodies[b].first_node + (center.z - 1u) * plane + (center.y - 1u) * row + center.x - 1u;
    var sum = vec4(0.0);
    for (var k = 0u; k < 3u; k++) {
        for (var j = 0u; j < 3u; j++) {
            let start = first + k * plane + j * row;
            let line = vec3(maps[start].y, maps[start + 1u].y, maps[start + 2u].y);
            let value = dot(line, x_weights);
            let across = vec3(y_weights[j] * z_weights[k], y_slopes[j] * z_weights[k], y_weights[j] * z_slopes[k]);
            sum += vec4(dot(line, x_slopes) * across.x, value * across.y, value * across.z, value * across.x);
        }
    }
    return vec4(inverse * sum.xyz, sum.w);
}
