#import gpu/index
#import sph/grid
#import surface/lattice
#import surface/walls
#import surface/candidates

#bindings

// See cpu.rs.
const SMOOTHING: f32 = 0.9;
const OTHER_LAYER: f32 = 0.25;
const BULK_VARIANCE: f32 = 0.1446;
const FLATTEST: f32 = 0.35;
const SATURATION: f32 = 0.25;
const MAX_SIZE: f32 = 1.4;
const FEW: f32 = 0.18;
const INTERIOR_NUMBER: f32 = 0.93;
const INTERIOR_OFFSET2: f32 = 0.0025;
const INTERIOR_DETERMINANT: f32 = 0.5 * BULK_VARIANCE * BULK_VARIANCE * BULK_VARIANCE;
const MAX_SHIFT: f32 = 0.125;

// The centre and the matrix of particle i for the means over its neighbours: offset, number, and the elements xx, yy, zz and
// xy, xz, yz of the covariance.
fn store_shape(i: u32, offset: vec3<f32>, number: f32, squares: vec3<f32>, products: vec3<f32>) {
    let own = neighbour_moments[3u * i];
    let deviation = SMOOTHING * (own.xyz - offset);
    let shift = deviation * (MAX_SHIFT / max(length(deviation), MAX_SHIFT));
    kernel_centres[i] = vec4<f32>(sorted_positions[i].xyz + lattice.support_radius * shift, 0.0);

    let t = clamp((own.w - 1.0) / (FEW * lattice.bulk_number), 0.0, 1.0);
    let crowd_size = clamp(sqrt(lattice.bulk_number / number), 1.0, MAX_SIZE);
    let size = lattice.lone_size + t * (crowd_size - lattice.lone_size);
    let a = 1.0 + t * (FLATTEST + (1.0 - FLATTEST) * (1.0 + SATURATION) - 1.0);
    let b = SATURATION * (1.0 + t * (FLATTEST - 1.0));
    let s = squares / BULK_VARIANCE;
    let p = products / BULK_VARIANCE;
    // The square of the matrix, plus b / a.
    let s2 = s * s + p.xxy * p.xxy + p.yzz * p.yzz + b / a;
    let p2 = s.xxy * p + p * s.yzz + p.yxx * p.zzy;
    // Its inverse.
    let diagonal = s2.yxx * s2.zzy - p2.zyx * p2.zyx;
    let mixed = p2.yxx * p2.zzy - p2 * s2.zyx;
    let inverse = (SATURATION - b / a) / (s2.x * diagonal.x + p2.x * mixed.x + p2.y * mixed.y);
    let unscaled = lattice.inverse_support / size;
    let scale = unscaled * unscaled / a;
    let d = scale * (inverse * diagonal + 1.0);
    let m = scale * inverse * mixed;
    kernel_matrices[2u * i] = vec4<f32>(d.x, m.x, m.y, d.y);
    kernel_matrices[2u * i + 1u] = vec4<f32>(m.z, d.z, 1.0 / scale, 0.0);
}

fn is_interior(i: u32) -> bool {
    let mean = neighbour_moments[3u * i];
    let a = neighbour_moments[3u * i + 1u];
    let b = neighbour_moments[3u * i + 2u];
    let determinant = a.x * (a.w * b.y - b.x * b.x) + a.y * (a.z * b.x - a.y * b.y) + a.z * (a.y * b.x - a.z * a.w);
    return mean.w >= INTERIOR_NUMBER * lattice.bulk_number && dot(mean.xyz, mean.xyz) <= INTERIOR_OFFSET2
        && determinant >= INTERIOR_DETERMINANT;
}

@compute @workgroup_size(64)
fn shapes(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    if i >= min(cell_start[grid.cell_count], lattice.particle_capacity) {
        return;
    }
    let p = sorted_positions[i].xyz;
    let own = neighbour_moments[3u * i].xyz;
    let inverse2 = lattice.inverse_support * lattice.inverse_support;
    if is_interior(i) {
        kernel_centres[i] = vec4<f32>(p, neighbour_moments[3u * i + 2u].z);
        kernel_matrices[2u * i] = vec4<f32>(inverse2, 0.0, 0.0, inverse2);
        let radius2 = lattice.support_radius * lattice.support_radius;
        kernel_matrices[2u * i + 1u] = vec4<f32>(0.0, inverse2, radius2, 0.0);
        return;
    }
    let reach = vec3<f32>(lattice.support_radius);
    let cells = cell_range(p - reach, p + reach);
    var total = 0.0;
    // Offset and number.
    var means = vec4<f32>(0.0);
    // xx, yy, zz and xy, xz, yz
    var squares = vec3<f32>(0.0);
    var products = vec3<f32>(0.0);
    for (var left = wall_reflections(p, p); left != 0u; left &= left - 1u) {
        let by = wall_reflection(firstTrailingBit(left));
        let mixed = by.sign.xxy * by.sign.yzz;
        for (var z = cells.first.z; z < cells.last.z; z++) {
            for (var y = cells.first.y; y < cells.last.y; y++) {
                let row = (z * grid.size_y + y) * grid.size_x;
                let end = cell_start[row + cells.last.x];
                for (var j = cell_start[row + cells.first.x]; j < end; j++) {
                    let d = by.sign * sorted_positions[j].xyz + by.shift - p;
                    let q2 = dot(d, d) * inverse2;
                    if q2 >= 1.0 {
                        continue;
                    }
                    let mean = vec4<f32>(by.sign, 1.0) * neighbour_moments[3u * j];
                    let other = mean.xyz - own;
                    let similar = max(1.0 - dot(other, other) / (OTHER_LAYER * OTHER_LAYER), 0.0);
                    let w = (1.0 - q2 * sqrt(q2)) * similar * similar;
                    let a = neighbour_moments[3u * j + 1u];
                    let b = neighbour_moments[3u * j + 2u];
                    total += w;
                    means += w * mean;
                    squares += w * vec3<f32>(a.x, a.w, b.y);
                    products += w * mixed * vec3<f32>(a.y, a.z, b.x);
                }
            }
        }
    }
    let inverse = 1.0 / total;
    store_shape(i, inverse * means.xyz, inverse * means.w, inverse * squares, inverse * products);
}
