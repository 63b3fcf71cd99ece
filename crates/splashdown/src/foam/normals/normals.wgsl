#import gpu/index
#import sph/params
#import sph/grid
#import sph/rows
#import sph/kernel
#import sph/foam

#bindings

const LEAST_NORMAL: f32 = 0.5;

@compute @workgroup_size(64)
fn normals(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    if (foam_state.is_due == 0u || i >= active_count()) {
        return;
    }
    let x = sorted_positions[i].xyz;
    let rows = rows_around(x);
    let scale = 1.0 / params.support_radius;
    let reach = params.support_radius * params.support_radius;
    var sum = vec3(0.0);
    for (var row = 0u; row < 9u; row++) {
        let range = row_range(rows, row);
        for (var j = range.x; j < range.y; j++) {
            let d = x - sorted_positions[j].xyz;
            let r2 = dot(d, d);
            if (r2 < reach) {
                sum -= kernel_g(sqrt(r2) * scale) * d;
            }
        }
    }
    let share = params.particle_spacing * scale;
    var n = share * share * share * scale * sum;
    for (var axis = 0u; axis < 3u; axis++) {
        let low = ((params.closed >> (2u * axis)) & 1u) == 1u && x[axis] - params.domain_min[axis] < params.support_radius;
        let high = ((params.closed >> (2u * axis + 1u)) & 1u) == 1u && params.domain_max[axis] - x[axis] < params.support_radius;
        if ((low && n[axis] < 0.0) || (high && n[axis] > 0.0)) {
            n[axis] = 0.0;
        }
    }
    let size = length(n);
    foam_normals[i] = select(vec4(0.0), vec4(n / max(size, 1e-20), 1.0), size >= LEAST_NORMAL);
}
