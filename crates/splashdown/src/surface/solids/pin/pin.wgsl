#import gpu/index
#import surface/lattice
#import sph/body
#import sph/body_map

#bindings

// A vertex lies on a body if it is within this many cells of its surface. At sharp edges, which the map rounds, vertices are
// a quarter of a cell away.
const ON_BODY: f32 = 0.3;

@compute @workgroup_size(64)
fn pin(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let v = linear_index(gid, groups, 64u);
    if v >= status.vertices {
        return;
    }
    let x = vertex_positions[v].xyz;
    var nearest = 1e30;
    for (var b = 0u; b < arrayLength(&bodies); b++) {
        let away = x - bodies[b].position;
        if dot(away, away) >= bodies[b].radius * bodies[b].radius {
            continue;
        }
        let y = body_point(b, x);
        if is_in_map(b, y) {
            nearest = min(nearest, field_at(b, y).distance);
        }
    }
    if abs(nearest) < ON_BODY * lattice.cell_size {
        vertex_positions[v].w = 0.0;
    }
}
