#import gpu/index
#import sph/grid
#import surface/lattice

#bindings

@compute @workgroup_size(64)
fn mark(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    if i >= min(cell_start[grid.cell_count], lattice.particle_capacity) {
        return;
    }
    let p = samples[i].xyz - lattice.origin;
    let blocks = vec3<u32>(lattice.blocks_x, lattice.blocks_y, lattice.blocks_z);
    let most = vec3<f32>(blocks * 8u - 1u);
    let low = floor((p - lattice.reach) * lattice.inverse_cell) - 1.0;
    let high = floor((p + lattice.reach) * lattice.inverse_cell);
    let first = vec3<u32>(clamp(low, vec3<f32>(0.0), most)) / 8u;
    let last = vec3<u32>(clamp(high, vec3<f32>(0.0), most)) / 8u;
    for (var z = first.z; z <= last.z; z++) {
        for (var y = first.y; y <= last.y; y++) {
            for (var x = first.x; x <= last.x; x++) {
                atomicStore(&marks[(z * blocks.y + y) * blocks.x + x], 1u);
            }
        }
    }
}
