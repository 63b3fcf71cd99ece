#import gpu/index
#import sph/params

#bindings

@compute @workgroup_size(64)
fn state_equation(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    if (i >= state.run_count) {
        return;
    }
    let rho = sorted_velocities[i].w;
    densities[i] = vec2(rho, pressure_at(rho));
}
