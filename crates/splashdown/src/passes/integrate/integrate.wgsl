#import gpu/index
#import sph/params
#import sph/grid
#import sph/advance

#bindings

override COUNTS: u32 = 1u; // 0: another pass counts the particles for the next step

@compute @workgroup_size(256)
fn integrate(
    @builtin(global_invocation_id) gid: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    begin_advance(local);
    let i = linear_index(gid, groups, 256u);
    if (i < state.run_count) {
        let change = Change(accelerations[i].xyz, vec3(0.0), densities[i].x);
        let cell = advance(i, sorted_positions[i], sorted_velocities[i], change);
        if (COUNTS == 1u && !is_last_step(state.dt, state.remaining)) {
            count_particle(i, cell);
        }
    }
    end_advance(i, local);
}
