#import gpu/index
#import surface/lattice

#bindings

@compute @workgroup_size(1)
fn plan() {
    let needed = mark_starts[lattice.block_count];
    let blocks = min(needed, lattice.block_capacity);
    status.blocks = blocks;
    status.blocks_needed = needed;
    let groups = dispatch_groups(blocks);
    block_groups[0] = groups.x;
    block_groups[1] = groups.y;
    block_groups[2] = groups.z;
}
