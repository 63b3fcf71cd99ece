#import surface/status

// Mirrors Lattice in params.rs.
struct Lattice {
    origin: vec3<f32>,
    cell_size: f32,
    blocks_x: u32,
    blocks_y: u32,
    blocks_z: u32,
    block_count: u32,
    support_radius: f32,
    inverse_support: f32,
    inverse_cell: f32,
    iso_level: f32,
    block_capacity: u32,
    vertex_capacity: u32,
    triangle_capacity: u32,
    particle_capacity: u32,
}

// In block_slot: the block is not marked.
const NONE: u32 = 0xffffffffu;

// Coordinates of a block, in blocks. The pass binds `lattice`.
fn block_place(block: u32) -> vec3<i32> {
    let rest = block / lattice.blocks_x;
    return vec3<i32>(vec3<u32>(block % lattice.blocks_x, rest % lattice.blocks_y, rest / lattice.blocks_y));
}

// Position of a node.
fn node_position(node: vec3<i32>) -> vec3<f32> {
    return lattice.origin + lattice.cell_size * vec3<f32>(node);
}
