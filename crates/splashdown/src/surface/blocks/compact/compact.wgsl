#import gpu/index
#import surface/lattice

#bindings

@compute @workgroup_size(64)
fn compact(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let block = linear_index(gid, groups, 64u);
    if block >= lattice.block_count {
        return;
    }
    let slot = mark_starts[block];
    if marks[block] != 0u && slot < lattice.block_capacity {
        block_list[slot] = block;
        block_slot[block] = slot;
    } else {
        block_slot[block] = NONE;
    }
}
