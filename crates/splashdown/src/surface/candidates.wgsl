// The range of cells that intersect a box. The pass binds `grid`.
struct CellRange {
    first: vec3<u32>,
    last: vec3<u32>, // one past the last
}

fn cell_range(low: vec3<f32>, high: vec3<f32>) -> CellRange {
    let size = vec3<f32>(vec3<u32>(grid.size_x, grid.size_y, grid.size_z));
    let first = floor(coordinates(low));
    let last = floor(coordinates(high)) + 1.0;
    // The range is empty if the box is outside the grid.
    let zero = vec3<f32>(0.0);
    return CellRange(vec3<u32>(clamp(first, zero, size)), vec3<u32>(clamp(last, zero, size)));
}
