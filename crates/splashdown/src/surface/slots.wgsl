// The slot of the block at given coordinates. The pass binds `lattice` and `block_slot`, and
// imports surface/lattice.
fn slot_at(place: vec3<i32>) -> u32 {
    let p = vec3<u32>(place);
    // Negative coordinates wrap to large numbers.
    if p.x >= lattice.blocks_x || p.y >= lattice.blocks_y || p.z >= lattice.blocks_z {
        return NONE;
    }
    return block_slot[(p.z * lattice.blocks_y + p.y) * lattice.blocks_x + p.x];
}
