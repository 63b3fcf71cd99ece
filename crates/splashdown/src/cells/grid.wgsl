// Mirrors Grid in grid.rs.
struct Grid {
    origin: vec3<f32>,
    cell_count: u32,
    cells_per_metre: vec3<f32>,
    size_x: u32,
    size_y: u32,
    size_z: u32,
    slices: u32,
    unused: u32,
}

// The position of a point in cells.
fn coordinates(x: vec3<f32>) -> vec3<f32> {
    return (x - grid.origin) * grid.cells_per_metre;
}

// The indices of the cell of a point along the axes; for points outside, of the nearest cell that is not a ghost.
fn indices_of(x: vec3<f32>) -> vec3<u32> {
    let ghosts = vec3(i32(grid.slices), 1, 1);
    let last = vec3(i32(grid.size_x), i32(grid.size_y), i32(grid.size_z)) - ghosts - 1;
    return vec3<u32>(clamp(vec3<i32>(coordinates(x)), ghosts, last));
}

fn cell_of(x: vec3<f32>) -> u32 {
    let c = indices_of(x);
    return (c.z * grid.size_y + c.y) * grid.size_x + c.x;
}
