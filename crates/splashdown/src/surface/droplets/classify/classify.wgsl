#import gpu/index
#import sph/grid
#import sph/rows
#import surface/lattice

#bindings

// Mirrors MAX_BLOB in droplets/mod.rs.
const MAX_BLOB = 32u;

@compute @workgroup_size(64)
fn classify(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    if i >= min(active_count(), lattice.particle_capacity) {
        return;
    }
    // The blob as far as it is known. The links of the first `next` members have been followed.
    var blob: array<u32, MAX_BLOB>;
    blob[0] = i;
    var count = 1u;
    var neighbours = 0u;
    var is_kept = false;
    for (var next = 0u; next < count && !is_kept; next++) {
        let x = sorted_positions[blob[next]].xyz;
        let rows = rows_around(x);
        for (var row = 0u; row < 9u && !is_kept; row++) {
            // The row of the particle first: inside the fluid it is sufficient.
            let range = row_range(rows, (row + 4u) % 9u);
            for (var j = range.x; j < range.y && !is_kept; j++) {
                let d = sorted_positions[j].xyz - x;
                var is_new = dot(d, d) < lattice.link_square;
                for (var k = 0u; k < count && is_new; k++) {
                    is_new = blob[k] != j;
                }
                if is_new {
                    neighbours += select(0u, 1u, next == 0u);
                    if count < lattice.min_blob {
                        blob[count] = j;
                        count++;
                    }
                    is_kept = count >= lattice.min_blob && neighbours >= lattice.min_neighbours;
                }
            }
        }
        // Not all links of the particle itself are needed to find the blob.
        if neighbours < lattice.min_neighbours {
            break;
        }
    }
    kept[i] = select(0u, 1u, is_kept || (count >= lattice.min_blob && neighbours >= lattice.min_neighbours));
}
