// Mirrors Status in params.rs.
struct Status {
    blocks: u32,
    blocks_needed: u32,
    vertices: u32,
    vertices_needed: u32,
    triangles: u32,
    triangles_needed: u32,
}
