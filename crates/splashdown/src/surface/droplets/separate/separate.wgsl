#import gpu/index
#import sph/grid
#import surface/lattice
#import surface/droplet

#bindings

@compute @workgroup_size(64)
fn separate(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    if i >= min(cell_start[grid.cell_count], lattice.particle_capacity) {
        return;
    }
    let start = kept_starts[i];
    if kept[i] != 0u {
        kept_positions[start] = sorted_positions[i];
    } else {
        // Before particle i there are as many droplets as particles that do not remain.
        droplets[i - start] = Droplet(sorted_positions[i].xyz, sorted_ids[i], sorted_velocities[i].xyz, 0u);
    }
}
