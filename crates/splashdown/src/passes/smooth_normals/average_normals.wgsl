#import gpu/index
#import sph/params
#import sph/grid
#import sph/rows
#import sph/kernel
#import sph/images

#bindings

@compute @workgroup_size(64)
fn average_normals(
    @builtin(global_invocation_id) gid: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
) {
    let i = linear_index(gid, groups, 64u);
    if (i >= active_count()) {
        return;
    }
    let x = sorted_positions[i].xyz;
    let scale = 1.0 / params.support_radius;
    let reach = params.support_radius * params.support_radius;
    var sum = vec3(0.0);
    var weight = 0.0;
    for (var left = reflections_near(x); left != 0u; left &= left - 1u) {
        let by = reflection(firstTrailingBit(left));
        let own = reflected_point(by, x);
        sum *= by.sign;
        let rows = rows_of_image(x, own);
        for (var row = 0u; row < 9u; row++) {
            let range = row_range(rows, row);
            for (var j = range.x; j < range.y; j++) {
                let d = own - sorted_positions[j].xyz;
                let r2 = dot(d, d);
                if (r2 < reach) {
                    let w = kernel_w(sqrt(r2) * scale);
                    sum += w * normals[j].xyz;
                    weight += w;
                }
            }
        }
        sum *= by.sign;
    }
    smooth_normals[i] = vec4(sum / weight, 0.0);
}
