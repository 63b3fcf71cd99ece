// Traversal of neighbours on the GPU: the 27 cubes around a particle form nine rows (dy, dz) of cells along x, and a row
// is contiguous in the sorted arrays. Needs `grid` and `cell_start`.

// Square of the reach of a row around a point, in cubes. It is slightly larger than one against rounding.
const ROW_REACH2: f32 = 1.001;

struct Rows {
    first: u32, // the first cell of the first row
    corner: vec2<f32>, // its y and z, in cells
    at: vec3<f32>, // the point, in cells
}

// The rows around the cube of a point.
fn rows_around(x: vec3<f32>) -> Rows {
    return rows_of_image(x, x);
}

// The rows around the cube of a point, for an image of the point.
fn rows_of_image(x: vec3<f32>, image: vec3<f32>) -> Rows {
    let yz = indices_of(x).yz - 1u;
    return Rows((yz.y * grid.size_y + yz.x) * grid.size_x, vec2<f32>(yz), coordinates(image));
}

// The particles of the cells of a row that are within the edge of a cube of the point or of its image.
fn row_range(rows: Rows, row: u32) -> vec2<u32> {
    let dy = row % 3u;
    let dz = row / 3u;
    let low = rows.corner + vec2(f32(dy), f32(dz));
    let beyond = max(max(low - rows.at.yz, rows.at.yz - low - 1.0), vec2(0.0));
    let half2 = ROW_REACH2 - dot(beyond, beyond);
    if (half2 <= 0.0) {
        return vec2(0u);
    }
    let half = sqrt(half2) * f32(grid.slices);
    let ends = clamp(vec2<i32>(floor(rows.at.x + vec2(-half, half))) + vec2(0, 1), vec2(0), vec2(i32(grid.size_x)));
    let start = rows.first + (dz * grid.size_y + dy) * grid.size_x;
    return vec2(cell_start[start + u32(ends.x)], cell_start[start + u32(ends.y)]);
}

// The number of active particles.
fn active_count() -> u32 {
    return cell_start[grid.cell_count];
}
