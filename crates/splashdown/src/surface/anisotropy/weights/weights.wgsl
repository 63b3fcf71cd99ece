#import gpu/index
#import sph/grid
#import surface/lattice
#import surface/walls
#import sph/kernel
#import surface/candidates

#bindings

@compute @workgroup_size(64)
fn weights(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    if i >= min(cell_start[grid.cell_count], lattice.particle_capacity) {
        return;
    }
    let p = sorted_positions[i].xyz;
    let own = kernel_centres[i];
    if own.w != 0.0 {
        // Inside the fluid.
        samples[i] = vec4<f32>(own.xyz, -own.w);
        return;
    }
    let centre = own.xyz;
    let reach = vec3<f32>(lattice.support_radius);
    let inverse2 = lattice.inverse_support * lattice.inverse_support;
    let cells = cell_range(p - reach, p + reach);
    var sum = 0.0;
    for (var left = wall_reflections(p, p); left != 0u; left &= left - 1u) {
        let by = wall_reflection(firstTrailingBit(left));
        // The signs of the elements xy, xz, yz of the matrix of an image.
        let mixed = by.sign.xxy * by.sign.yzz;
        for (var z = cells.first.z; z < cells.last.z; z++) {
            for (var y = cells.first.y; y < cells.last.y; y++) {
                let row = (z * grid.size_y + y) * grid.size_x;
                let end = cell_start[row + cells.last.x];
                for (var j = cell_start[row + cells.first.x]; j < end; j++) {
                    let d = by.sign * sorted_positions[j].xyz + by.shift - p;
                    let window = min(4.0 * (1.0 - dot(d, d) * inverse2), 1.0);
                    if window <= 0.0 {
                        continue;
                    }
                    let e = by.sign * kernel_centres[j].xyz + by.shift - centre;
                    let a = kernel_matrices[2u * j];
                    let b = kernel_matrices[2u * j + 1u];
                    let products = mixed * vec3<f32>(a.y, a.z, b.x) * e.xxy * e.yzz;
                    let q2 = dot(vec3<f32>(a.x, a.w, b.y), e * e) + 2.0 * (products.x + products.y + products.z);
                    sum += window * kernel_w(sqrt(max(q2, 0.0)));
                }
            }
        }
    }
    samples[i] = vec4<f32>(centre, 1.0 / sum);
}
