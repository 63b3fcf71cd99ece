#import gpu/index
#import sph/params
#import sph/grid
#import sph/rows
#import sph/kernel
#import sph/foam

#bindings

// Cosine of the largest angle between the velocity and the normal of a wave crest.
const FORWARDS: f32 = 0.6;

@compute @workgroup_size(64)
fn potentials(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    if (foam_state.is_due == 0u || i >= active_count()) {
        return;
    }
    let v = sorted_velocities[i].xyz;
    let energy = 0.5 * dot(v, v);
    if (energy <= foam.energy_least) {
        foam_potentials[i] = vec4(0.0, 0.0, energy, 0.0);
        return;
    }
    let x = sorted_positions[i].xyz;
    let n = foam_normals[i];
    let rows = rows_around(x);
    let scale = 1.0 / params.support_radius;
    let reach = params.support_radius * params.support_radius;
    var trapped = 0.0;
    var curvature = 0.0;
    for (var row = 0u; row < 9u; row++) {
        let range = row_range(rows, row);
        for (var j = range.x; j < range.y; j++) {
            let d = x - sorted_positions[j].xyz;
            let r2 = dot(d, d);
            if (r2 < reach) {
                let w = kernel_w(sqrt(r2) * scale);
                let u = v - sorted_velocities[j].xyz;
                trapped += w * (length(u) - dot(u, d) / sqrt(max(r2, 1e-20)));
                let other = foam_normals[j];
                if (dot(d, n.xyz) > 0.0) {
                    curvature += w * other.w * (1.0 - dot(n.xyz, other.xyz));
                }
            }
        }
    }
    let share = params.particle_spacing * scale;
    let volume = share * share * share;
    let is_crest = dot(v, n.xyz) >= FORWARDS * length(v) && n.w > 0.0;
    foam_potentials[i] = vec4(volume * trapped, select(0.0, volume * curvature, is_crest), energy, 0.0);
}
