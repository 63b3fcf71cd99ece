// Traversal of neighbours on the GPU: the 27 cells around a particle form nine rows (dy, dz) of three cells along x, and
// a row is contiguous in the sorted arrays. Needs `grid` and `cell_start`.
fn row_range(cell: u32, row: u32) -> vec2<u32> {
    let dy = row % 3u;
    let dz = row / 3u;
    let first = cell + (dz * grid.size_y + dy) * grid.size_x - (grid.size_y + 1u) * grid.size_x - 1u;
    return vec2(cell_start[first], cell_start[first + 3u]);
}

// The number of active particles.
fn active_count() -> u32 {
    return cell_start[grid.cell_count];
}
