#import gpu/index
#import sph/grid
#import surface/lattice
#import surface/walls
#import sph/kernel
#import surface/candidates

#bindings

@compute @workgroup_size(64)
fn moments(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    if i >= min(cell_start[grid.cell_count], lattice.particle_capacity) {
        return;
    }
    let p = sorted_positions[i].xyz;
    let reach = vec3<f32>(lattice.support_radius);
    let cells = cell_range(p - reach, p + reach);
    var neighbours = 0.0;
    var kernels = 0.0;
    var number = 0.0;
    var first = vec3<f32>(0.0);
    // xx, yy, zz and xy, xz, yz
    var squares = vec3<f32>(0.0);
    var products = vec3<f32>(0.0);
    for (var left = wall_reflections(p, p); left != 0u; left &= left - 1u) {
        let by = wall_reflection(firstTrailingBit(left));
        for (var z = cells.first.z; z < cells.last.z; z++) {
            for (var y = cells.first.y; y < cells.last.y; y++) {
                let row = (z * grid.size_y + y) * grid.size_x;
                let end = cell_start[row + cells.last.x];
                for (var j = cell_start[row + cells.first.x]; j < end; j++) {
                    let d = (by.sign * sorted_positions[j].xyz + by.shift - p) * lattice.inverse_support;
                    let q2 = dot(d, d);
                    if q2 < 1.0 {
                        let q = sqrt(q2);
                        let w = 1.0 - q2 * q;
                        kernels += kernel_w(q);
                        neighbours += 1.0 - q2;
                        number += w;
                        first += w * d;
                        squares += w * d * d;
                        products += w * d.xxy * d.yzz;
                    }
                }
            }
        }
    }
    let inverse = 1.0 / number;
    let m = inverse * first;
    let covariance = inverse * squares - m * m;
    let mixed = inverse * products - m.xxy * m.yzz;
    neighbour_moments[3u * i] = vec4<f32>(m, number);
    neighbour_moments[3u * i + 1u] = vec4<f32>(covariance.x, mixed.x, mixed.y, covariance.y);
    neighbour_moments[3u * i + 2u] = vec4<f32>(mixed.z, covariance.z, 1.0 / kernels, 0.0);
    // Without the particle itself.
    local_density[i] = neighbours - 1.0;
}
