#import gpu/index
#import surface/lattice

@group(0) @binding(0) var<uniform> lattice: Lattice;
@group(0) @binding(1) var<storage, read> marks: array<u32>;
@group(0) @binding(2) var<storage, read> mark_starts: array<u32>;
@group(0) @binding(3) var<storage, read_write> block_list: array<u32>;
@group(0) @binding(4) var<storage, read_write> block_slot: array<u32>;

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
