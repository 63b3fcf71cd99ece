#import gpu/index
#import surface/lattice
#import surface/walls
#import sph/planes
#import sph/body
#import sph/body_map

#bindings

// Change of the field per cell at the surface of a body, over the iso level.
const SLOPE: f32 = 0.3;

// The value of the field at a signed distance from a body.
fn beside_body(value: f32, distance: f32) -> f32 {
    let q = clamp(distance * lattice.inverse_support, 0.0, 1.0);
    let completed = value / (1.0 - wall_plane(q).x);
    return min(completed, lattice.iso_level * (1.0 + SLOPE * distance * lattice.inverse_cell));
}

// Changes the values of a row of a block, and its signs.
fn change_row(slot: u32, row: u32) {
    let node = block_place(block_list[slot]) * 8 + vec3<i32>(0, i32(row & 7u), i32(row >> 3u));
    let begin = folded(node_position(node));
    let end = folded(node_position(node + vec3<i32>(7, 0, 0)));
    let middle = 0.5 * (begin + end);
    let length = 0.5 * abs(end.x - begin.x) + 8.0 * lattice.cell_size;
    let first = (slot * 64u + row) * 8u;
    var distances = array<f32, 8>(1e30, 1e30, 1e30, 1e30, 1e30, 1e30, 1e30, 1e30);
    var is_near = false;
    for (var b = 0u; b < arrayLength(&bodies); b++) {
        let away = middle - bodies[b].position;
        let reach = bodies[b].radius + length;
        if dot(away, away) >= reach * reach {
            continue;
        }
        for (var i = 0; i < 8; i++) {
            let y = body_point(b, folded(node_position(node + vec3<i32>(i, 0, 0))));
            if is_in_map(b, y) {
                distances[i] = min(distances[i], field_at(b, y).distance);
                is_near = true;
            }
        }
    }
    if !is_near {
        return;
    }
    for (var i = 0u; i < 8u; i++) {
        if distances[i] < lattice.support_radius {
            field_values[first + i] = beside_body(field_values[first + i], distances[i]);
        }
    }
    let low = vec4<f32>(field_values[first], field_values[first + 1u], field_values[first + 2u], field_values[first + 3u]);
    let high = vec4<f32>(field_values[first + 4u], field_values[first + 5u], field_values[first + 6u], field_values[first + 7u]);
    signs[slot * 64u + row] = row_signs(node, low, high);
}

@compute @workgroup_size(64)
fn clip(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) row: u32,
) {
    let slot = linear_group(group, groups);
    if slot < status.blocks {
        change_row(slot, row);
    }
}
