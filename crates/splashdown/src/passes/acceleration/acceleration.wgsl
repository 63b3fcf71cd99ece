#import gpu/index
#import sph/params
#import sph/grid
#import sph/rows
#import sph/kernel
#import sph/images
#import sph/candidates
#import sph/wall_friction
#import sph/tension
#import sph/forces

#bindings

const HAS_TENSION: bool = true;
@compute @workgroup_size(64)
fn acceleration(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    if (i >= active_count()) {
        return;
    }
    if (params.surface_tension > 0.0) {
        own_normal = normals[i].xyz;
    }
    let a = acceleration_of(i, sorted_positions[i].xyz, sorted_velocities[i].xyz, densities[i]);
    accelerations[i] = vec4(a, 0.0);
}
