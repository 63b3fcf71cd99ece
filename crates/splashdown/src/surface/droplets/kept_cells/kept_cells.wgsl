#import gpu/index
#import sph/grid
#import surface/lattice

#bindings

@compute @workgroup_size(64)
fn kept_cells(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let cell = linear_index(gid, groups, 64u);
    if cell > grid.cell_count {
        return;
    }
    let first = min(cell_start[cell], lattice.particle_capacity);
    kept_cell_start[cell] = kept_starts[first];
    if cell == grid.cell_count {
        droplet_count[0] = first - kept_starts[first];
    }
}
