#import gpu/index
#import sph/grid
#import sph/foam

#bindings

@compute @workgroup_size(64)
fn count(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    if (foam_state.is_due == 0u || i >= cell_start[grid.cell_count]) {
        return;
    }
    let p = foam_potentials[i];
    let trapped = foam.trapped_air * ramp(p.x, foam.trapped_air_least, foam.trapped_air_scale);
    let crest = foam.wave_crest * ramp(p.y, foam.wave_crest_least, foam.wave_crest_scale);
    let expected = ramp(p.z, foam.energy_least, foam.energy_scale) * (trapped + crest) * foam_state.dt;
    foam_counts[i] = u32(min(expected, MOST_BORN) + unit(seed_of(sorted_ids[i], foam_state.step)));
}
