#import gpu/index
#import sph/grid
#import surface/lattice
#import sph/kernel
#import surface/candidates

#bindings

fn smoothing_weight(p: vec3<f32>, cells: CellRange) -> f32 {
    let support2 = lattice.support_radius * lattice.support_radius;
    var sum = 0.0;
    var total = 0.0;
    for (var z = cells.first.z; z < cells.last.z; z++) {
        for (var y = cells.first.y; y < cells.last.y; y++) {
            let row = (z * grid.size_y + y) * grid.size_x;
            let end = cell_start[row + cells.last.x];
            for (var i = cell_start[row + cells.first.x]; i < end; i++) {
                let sample = samples[i];
                let d = sample.xyz - p;
                let r2 = dot(d, d);
                if r2 < support2 {
                    let weight = abs(sample.w) * kernel_w(sqrt(r2) * lattice.inverse_support);
                    sum += weight * local_density[i];
                    total += weight;
                }
            }
        }
    }
    // The total is zero at a vertex beyond the reach of all particles, on a very long edge: it does
    // not move.
    let s = clamp(sum / max(total, 1e-12) / 13.0, 0.0, 1.0);
    return s * s * s * (s * (6.0 * s - 15.0) + 10.0);
}

@compute @workgroup_size(64)
fn smoothing_weights(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let slot = linear_group(group, groups);
    if slot >= status.blocks {
        return;
    }
    let end = min(vertex_starts[slot + 1u], lattice.vertex_capacity);
    let reach = vec3<f32>(lattice.support_radius);
    for (var v = vertex_starts[slot] + local; v < end; v += 64u) {
        let p = vertex_positions[v].xyz;
        vertex_positions[v].w = smoothing_weight(p, cell_range(p - reach, p + reach));
    }
}
