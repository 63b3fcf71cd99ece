#import gpu/index
#import sph/grid
#import surface/lattice
#import surface/walls
#import sph/kernel
#import surface/candidates

#bindings

@compute @workgroup_size(64)
fn volume(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    if i >= min(cell_start[grid.cell_count], lattice.particle_capacity) {
        return;
    }
    let p = sorted_positions[i].xyz;
    let reach = vec3<f32>(lattice.support_radius);
    let support2 = lattice.support_radius * lattice.support_radius;
    let cells = cell_range(p - reach, p + reach);
    var sum = 0.0;
    var neighbours = 0.0;
    for (var left = wall_reflections(p, p); left != 0u; left &= left - 1u) {
        let by = wall_reflection(firstTrailingBit(left));
        for (var z = cells.first.z; z < cells.last.z; z++) {
            for (var y = cells.first.y; y < cells.last.y; y++) {
                let row = (z * grid.size_y + y) * grid.size_x;
                let end = cell_start[row + cells.last.x];
                for (var j = cell_start[row + cells.first.x]; j < end; j++) {
                    let d = by.sign * sorted_positions[j].xyz + by.shift - p;
                    let r2 = dot(d, d);
                    if r2 < support2 {
                        sum += kernel_w(sqrt(r2) * lattice.inverse_support);
                        neighbours += 1.0 - r2 * lattice.inverse_support * lattice.inverse_support;
                    }
                }
            }
        }
    }
    samples[i] = vec4<f32>(p, 1.0 / sum);
    // Without the particle itself.
    local_density[i] = neighbours - 1.0;
}
