#import gpu/index
#import sph/params
#import sph/grid
#import sph/rows
#import sph/kernel
#import sph/images

#bindings

@compute @workgroup_size(64)
fn density(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    if (i >= active_count()) {
        return;
    }
    let x = sorted_positions[i].xyz;
    let scale = 1.0 / params.support_radius;
    let reach = params.support_radius * params.support_radius;
    var sum = 0.0;
    for (var left = reflections_near(x); left != 0u; left &= left - 1u) {
        let by = reflection(firstTrailingBit(left));
        let own = reflected_point(by, x);
        let rows = rows_of_image(x, own);
        for (var row = 0u; row < 9u; row++) {
            let range = row_range(rows, row);
            // Four at a time, so that their positions are loaded together.
            for (var j = range.x; j < range.y; j += 4u) {
                let last = range.y - 1u;
                let a = own - sorted_positions[j].xyz;
                let b = own - sorted_positions[min(j + 1u, last)].xyz;
                let c = own - sorted_positions[min(j + 2u, last)].xyz;
                let d = own - sorted_positions[min(j + 3u, last)].xyz;
                let squares = vec4(dot(a, a), dot(b, b), dot(c, c), dot(d, d));
                let is_there = vec4(j, j + 1u, j + 2u, j + 3u) < vec4(range.y);
                // The kernel is zero at the support.
                let r2 = select(vec4(reach), squares, is_there);
                if (any(r2 < vec4(reach))) {
                    let q = min(sqrt(r2) * scale, vec4(1.0));
                    sum += kernel_w(q.x);
                    sum += kernel_w(q.y);
                    sum += kernel_w(q.z);
                    sum += kernel_w(q.w);
                }
            }
        }
    }
    let rho = params.summed_mass * scale * scale * scale * sum;
    densities[i] = vec2(rho, pressure_at(rho));
}
