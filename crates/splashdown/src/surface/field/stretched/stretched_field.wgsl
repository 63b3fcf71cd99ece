#import gpu/index
#import sph/grid
#import surface/lattice
#import surface/walls
#import sph/kernel
#import surface/candidates
#import surface/field_row

#bindings

// Above this iso level a block is evaluated in any case; see cpu.rs.
const INTERIOR_ISO: f32 = 0.6;
const INSIDE: RowValues = RowValues(vec4<f32>(1.0), vec4<f32>(1.0));
// Factor on the support radius against rounding.
const NEAR: f32 = 1.0001;
// The most rows of cells that a block distinguishes.
const CELL_ROWS: u32 = 256u;

// The rows of cells that the block can reach which contain particles at the surface of the fluid, one bit each, and whether
// there are any particles, and any at the surface.
var<workgroup> surface_rows: array<atomic<u32>, 8>;
var<workgroup> has_particles: atomic<u32>;
var<workgroup> has_surface: atomic<u32>;

// The cells that the block can reach.
var<private> block_cells: CellRange;

fn cells_near_block(slot: u32) -> CellRange {
    let node = first_node(slot, 0u);
    var low = folded(node_position(node));
    var high = low;
    for (var n = 1; n < 8; n++) {
        let x = folded(node_position(node + n));
        low = min(low, x);
        high = max(high, x);
    }
    return cell_range(low - lattice.search_reach, high + lattice.search_reach);
}

// Searches every 32nd row of cells for particles at the surface, whose weights are not negative.
fn search_rows(first: u32) {
    let size = block_cells.last - block_cells.first;
    for (var k = first; k < size.y * size.z; k += 32u) {
        let place = block_cells.first.yz + vec2<u32>(k % size.y, k / size.y);
        let cell_row = (place.y * grid.size_y + place.x) * grid.size_x;
        let start = cell_start[cell_row + block_cells.first.x];
        let end = cell_start[cell_row + block_cells.last.x];
        if start < end {
            atomicOr(&has_particles, 1u);
        }
        for (var i = start; i < end; i++) {
            if !(samples[i].w < 0.0) {
                atomicOr(&surface_rows[k % CELL_ROWS / 32u], 1u << (k % 32u));
                atomicOr(&has_surface, 1u);
                break;
            }
        }
    }
}

// Without particles at the surface, whose kernels can be stretched, a row is visited within the support radius only.
fn cells_of_row(row: vec2<u32>, cells: CellRange, near: CellRange) -> vec2<u32> {
    let place = row - block_cells.first.yz;
    let k = (place.y * (block_cells.last.y - block_cells.first.y) + place.x) % CELL_ROWS;
    if ((atomicLoad(&surface_rows[k / 32u]) >> (k % 32u)) & 1u) == 1u {
        return vec2<u32>(cells.first.x, cells.last.x);
    }
    let is_near = all(row >= near.first.yz) && all(row < near.last.yz);
    return select(vec2<u32>(0u), vec2<u32>(near.first.x, near.last.x), is_near);
}

// Two rows next to each other along y, which read each sample once.
struct Pair {
    first: RowNodes,
    second: RowNodes,
}

struct PairValues {
    first: RowValues,
    second: RowValues,
}

// An ellipsoid: its centre, its weight, and its matrix, (xx, xy, xz, yy) and (yz, zz).
struct Ellipsoid {
    at: vec3<f32>,
    weight: f32,
    shape: vec4<f32>,
    more: vec2<f32>,
}

// What an ellipsoid adds to a row. q^2 = (xx a + linear) a + constant at the distance a along x.
fn contribution(e: Ellipsoid, nodes: RowNodes) -> RowValues {
    let d = nodes.yz - e.at.yz;
    let linear = 2.0 * (e.shape.y * d.x + e.shape.z * d.y);
    let constant = (e.shape.w * d.x + 2.0 * e.more.x * d.y) * d.x + e.more.y * d.y * d.y;
    // The least value within the row.
    let lowest = clamp(-0.5 * linear / e.shape.x, nodes.first_x - e.at.x, nodes.last_x - e.at.x);
    if (e.shape.x * lowest + linear) * lowest + constant >= 1.0 {
        return RowValues(vec4<f32>(0.0), vec4<f32>(0.0));
    }
    let a = nodes.low_x - e.at.x;
    let b = nodes.high_x - e.at.x;
    return RowValues(
        e.weight * kernel_w4(sqrt(max((e.shape.x * a + linear) * a + constant, vec4<f32>(0.0)))),
        e.weight * kernel_w4(sqrt(max((e.shape.x * b + linear) * b + constant, vec4<f32>(0.0)))),
    );
}

// Adds the kernel of sample i with a reflection to two rows.
fn add(i: u32, by: WallReflection, nodes: Pair, values: ptr<function, PairValues>) {
    let sample = samples[i];
    let at = by.sign * sample.xyz + by.shift;
    let least_yz = min(nodes.first.yz, nodes.second.yz);
    let most_yz = max(nodes.first.yz, nodes.second.yz);
    let yz = max(max(least_yz - at.yz, at.yz - most_yz), vec2<f32>(0.0));
    let x = distance_outside(nodes.first, at.x);
    let distance2 = dot(yz, yz) + x * x;
    if distance2 >= lattice.reach * lattice.reach {
        return;
    }
    // z: the square of a bound of the half-axes
    let more = kernel_matrices[2u * i + 1u];
    if distance2 >= more.z {
        return;
    }
    // The signs of the elements xy, xz, yz of the matrix of an image.
    let mixed = by.sign.xxy * by.sign.yzz;
    let shape = kernel_matrices[2u * i] * vec4<f32>(1.0, mixed.xy, 1.0);
    let ellipsoid = Ellipsoid(at, abs(sample.w), shape, vec2<f32>(mixed.z * more.x, more.y));
    let first = contribution(ellipsoid, nodes.first);
    let second = contribution(ellipsoid, nodes.second);
    (*values).first.low += first.low;
    (*values).first.high += first.high;
    (*values).second.low += second.low;
    (*values).second.high += second.high;
}

fn evaluate(nodes: Pair) -> PairValues {
    let least_yz = min(nodes.first.yz, nodes.second.yz);
    let most_yz = max(nodes.first.yz, nodes.second.yz);
    let near_end = vec3<f32>(nodes.first.first_x, least_yz);
    let far_end = vec3<f32>(nodes.first.last_x, most_yz);
    let cells = cell_range(near_end - lattice.search_reach, far_end + lattice.search_reach);
    let near_reach = NEAR * lattice.support_radius;
    let near = cell_range(near_end - near_reach, far_end + near_reach);
    let none = RowValues(vec4<f32>(0.0), vec4<f32>(0.0));
    var values = PairValues(none, none);
    for (var left = wall_reflections(near_end, far_end); left != 0u; left &= left - 1u) {
        let by = wall_reflection(firstTrailingBit(left));
        for (var z = cells.first.z; z < cells.last.z; z++) {
            for (var y = cells.first.y; y < cells.last.y; y++) {
                let visited = cells_of_row(vec2<u32>(y, z), cells, near);
                let cell_row = (z * grid.size_y + y) * grid.size_x;
                let end = cell_start[cell_row + visited.y];
                for (var i = cell_start[cell_row + visited.x]; i < end; i++) {
                    add(i, by, nodes, &values);
                }
            }
        }
    }
    return values;
}

@compute @workgroup_size(32)
fn stretched_field(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let slot = linear_group(group, groups);
    let is_block = slot < status.blocks;
    if local < 8u {
        atomicStore(&surface_rows[local], 0u);
    }
    if local == 0u {
        atomicStore(&has_particles, 0u);
        atomicStore(&has_surface, 0u);
    }
    workgroupBarrier();
    if is_block {
        block_cells = cells_near_block(slot);
        search_rows(local);
    }
    workgroupBarrier();
    if !is_block {
        return;
    }
    let row = 2u * local;
    let is_interior = atomicLoad(&has_particles) == 1u && atomicLoad(&has_surface) == 0u;
    var values = PairValues(INSIDE, INSIDE);
    if !(is_interior && lattice.iso_level <= INTERIOR_ISO) {
        values = evaluate(Pair(row_nodes(first_node(slot, row)), row_nodes(first_node(slot, row + 1u))));
    }
    write_row(slot, row, values.first);
    write_row(slot, row + 1u, values.second);
}
