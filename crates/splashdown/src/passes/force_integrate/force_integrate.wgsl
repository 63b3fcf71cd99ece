#import gpu/index
#import sph/params
#import sph/grid
#import sph/rows
#import sph/kernel
#import sph/images
#import sph/candidates
#import sph/wall_friction
#import sph/forces
#import sph/advance

#bindings

// Surface tension needs a ninth storage buffer; scenes with it use the separate passes.
const HAS_TENSION: bool = false;

fn tension_between(
    i: u32,
    j: u32,
    sign: vec3<f32>,
    d: vec3<f32>,
    q: f32,
    rho_i: f32,
    rho_j: f32,
) -> vec3<f32> {
    return vec3(0.0);
}

@compute @workgroup_size(64)
fn force_integrate(
    @builtin(global_invocation_id) gid: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    begin_advance(local);
    let i = linear_index(gid, groups, 64u);
    if (i < state.run_count) {
        let p = sorted_positions[i];
        let v = sorted_velocities[i];
        let own = densities[i];
        var a = vec3(0.0);
        if (i < active_count()) {
            a = acceleration_of(i, p.xyz, v.xyz, own);
        }
        let cell = advance(i, p, v, Change(a, vec3(0.0), own.x));
        if (!is_last_step(state.dt, state.remaining)) {
            count_particle(i, cell);
        }
    }
    end_advance(i, local);
}
