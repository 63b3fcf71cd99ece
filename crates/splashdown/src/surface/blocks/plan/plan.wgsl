#import gpu/index
#import surface/lattice

@group(0) @binding(0) var<uniform> lattice: Lattice;
@group(0) @binding(1) var<storage, read> mark_starts: array<u32>;
@group(0) @binding(2) var<storage, read_write> status: Status;
@group(0) @binding(3) var<storage, read_write> block_groups: array<u32>;

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
