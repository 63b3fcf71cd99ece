// Mirrors Grid in grid.rs.
struct Grid {
    origin: vec3<f32>,
    cells_per_metre: f32,
    size_x: u32,
    size_y: u32,
    size_z: u32,
    cell_count: u32,
}

// The cell of a point; for points outside, the nearest cell that is not a ghost.
fn cell_of(x: vec3<f32>) -> u32 {
    let at = vec3<i32>((x - grid.origin) * grid.cells_per_metre);
    let c = vec3<u32>(clamp(at, vec3(1), vec3(i32(grid.size_x), i32(grid.size_y), i32(grid.size_z)) - 2));
    return (c.z * grid.size_y + c.y) * grid.size_x + c.x;
}
