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
    wall_low: vec3<f32>,
    wall_margin: f32,
    wall_high: vec3<f32>,
    reach: f32,
    wall_low_nodes: vec3<u32>,
    search_reach: f32,
    wall_high_nodes: vec3<u32>,
    bulk_number: f32,
    min_blob: u32,
    min_neighbours: u32,
    link_square: f32,
    lone_size: f32,
}

// In block_slot: the block is not marked.
const NONE: u32 = 0xffffffffu;
// Distance in wall margins of the layer of nodes that is moved to a wall.
const LAYER_MARGINS: f32 = 2.0;

// Coordinates of a block, in blocks. The pass binds `lattice`.
fn block_place(block: u32) -> vec3<i32> {
    let rest = block / lattice.blocks_x;
    return vec3<i32>(vec3<u32>(block % lattice.blocks_x, rest % lattice.blocks_y, rest / lattice.blocks_y));
}

// Position of a node: a multiple of the cell size, except for the layers next to walls; see Lattice::coordinate.
fn node_position(node: vec3<i32>) -> vec3<f32> {
    let regular = lattice.origin + lattice.cell_size * vec3<f32>(node);
    let layer = vec3<f32>(LAYER_MARGINS * lattice.wall_margin);
    let moved_up = select(regular, lattice.wall_high - layer, vec3<u32>(node) == lattice.wall_high_nodes);
    return select(moved_up, lattice.wall_low + layer, vec3<u32>(node) == lattice.wall_low_nodes);
}

// The same along x, for four nodes.
fn node_positions_x(nodes: vec4<u32>) -> vec4<f32> {
    let regular = vec4<f32>(lattice.origin.x) + lattice.cell_size * vec4<f32>(nodes);
    let layer = LAYER_MARGINS * lattice.wall_margin;
    let high = vec4<f32>(lattice.wall_high.x - layer);
    let low = vec4<f32>(lattice.wall_low.x + layer);
    let moved_up = select(regular, high, nodes == vec4<u32>(lattice.wall_high_nodes.x));
    return select(moved_up, low, nodes == vec4<u32>(lattice.wall_low_nodes.x));
}
