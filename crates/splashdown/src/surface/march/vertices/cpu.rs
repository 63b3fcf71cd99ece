use glam::Vec3;
use rayon::prelude::*;

use super::VerticesBindings;
use crate::surface::params::{Lattice, NODES, NONE, SIDE};
use crate::surface::parts::by_starts;

const N: usize = SIDE as usize;
/// The nodes of a block with one layer below and two above: the neighbours of the ends of all its
/// edges.
const WIDE: usize = N + 3;

pub(super) fn vertices(buffers: VerticesBindings<'_>) {
    let VerticesBindings { lattice, block_list, block_slot, field_values, rows, .. } = buffers;
    let starts = &buffers.vertex_starts[..=buffers.status.blocks as usize];
    let positions = by_starts(buffers.vertex_positions, starts);
    let normals = by_starts(buffers.normals, starts);
    let outputs =
        positions.into_iter().zip(normals).enumerate().filter(|(_, (positions, _))| !positions.is_empty());
    let outputs: Vec<_> = outputs.collect();
    outputs.into_par_iter().for_each_init(
        || vec![0.0; WIDE * WIDE * WIDE],
        |wide, (slot, (positions, normals))| {
            let place = lattice.block_place(block_list[slot]);
            widen(lattice, block_slot, field_values, place, wide);
            let edges = rows[slot * N * N..][..N * N].iter().enumerate().flat_map(|(row, data)| {
                (0..24).filter(move |edge| data.x >> edge & 1 == 1).map(move |edge| (row, edge))
            });
            for (((row, edge), position), normal) in edges.zip(positions).zip(normals) {
                let local = [edge & 7, row & 7, row >> 3];
                let (at, outwards) = vertex(lattice, wide, place, local, edge >> 3);
                *position = at.extend(0.0);
                *normal = outwards.extend(0.0);
            }
        },
    );
}

/// Copies the values of a block and around it; zero in blocks that are not marked.
fn widen(lattice: &Lattice, slot_of: &[u32], values: &[f32], place: [i32; 3], wide: &mut [f32]) {
    wide.fill(0.0);
    for neighbour in 0..27_i32 {
        let offset = [neighbour % 3 - 1, neighbour / 3 % 3 - 1, neighbour / 9 - 1];
        let at = std::array::from_fn(|axis| place[axis] + offset[axis]);
        let slot = lattice.block_at(at).map_or(NONE, |block| slot_of[block]);
        if slot == NONE {
            continue;
        }
        let block = &values[slot as usize * NODES..][..NODES];
        // In the extended array the block begins at 1. Of the neighbours below, the last layer is
        // needed; of those above, the first two.
        let range = |axis: usize| match offset[axis] {
            -1 => (N - 1..N, 0),
            0 => (0..N, 1),
            _ => (0..2, N + 1),
        };
        let ((xs, to_x), (ys, to_y), (zs, to_z)) = (range(0), range(1), range(2));
        for (dz, z) in zs.enumerate() {
            for (dy, y) in ys.clone().enumerate() {
                let from = &block[(z * N + y) * N..][xs.clone()];
                let to = ((to_z + dz) * WIDE + to_y + dy) * WIDE + to_x;
                wide[to..to + from.len()].copy_from_slice(from);
            }
        }
    }
}

fn vertex(lattice: &Lattice, wide: &[f32], place: [i32; 3], local: [usize; 3], axis: usize) -> (Vec3, Vec3) {
    const STEPS: [usize; 3] = [1, WIDE, WIDE * WIDE];
    let node = ((local[2] + 1) * WIDE + local[1] + 1) * WIDE + local[0] + 1;
    let own: [u32; 3] = std::array::from_fn(|axis| place[axis] as u32 * SIDE + local[axis] as u32);
    let mut next = own;
    next[axis] += 1;
    // In units of the field per cell; the layers of nodes next to walls are at other distances.
    let gradient = |i: usize, node: [u32; 3]| {
        Vec3::from_array(std::array::from_fn(|axis| {
            let [below, above] = [node[axis].wrapping_sub(1), node[axis] + 1];
            let distance = lattice.coordinate(axis, above) - lattice.coordinate(axis, below);
            (wide[i + STEPS[axis]] - wide[i - STEPS[axis]]) * (lattice.cell_size / distance)
        }))
    };
    let (a, b) = (wide[node], wide[node + STEPS[axis]]);
    let t = ((lattice.iso_level - a) / (b - a)).clamp(0.001, 0.999);
    let along = Vec3::AXES[axis];
    let corner = Vec3::from_array(std::array::from_fn(|axis| lattice.coordinate(axis, own[axis])));
    let length = lattice.coordinate(axis, next[axis]) - corner[axis];
    if let Some(on_wall) = on_wall(lattice, corner, axis, length, [a, b], t) {
        return on_wall;
    }
    let outwards = -gradient(node, own).lerp(gradient(node + STEPS[axis], next), t);
    let length2 = outwards.length_squared();
    let outwards = if length2 > 1e-20 {
        outwards / length2.sqrt()
    } else if a > b {
        // The gradient is zero: use the direction from the inside end to the outside end.
        along
    } else {
        -along
    };
    (corner + along * (t * length), outwards)
}

/// The vertex and its normal on a wall, if the edge from `corner` along `axis` crosses a wall before the field falls to
/// the iso level. `[a, b]`: the field at both ends; `t`: where it reaches the iso level.
fn on_wall(
    lattice: &Lattice,
    corner: Vec3,
    axis: usize,
    length: f32,
    [a, b]: [f32; 2],
    t: f32,
) -> Option<(Vec3, Vec3)> {
    let (low, high) = (lattice.wall_low[axis], lattice.wall_high[axis]);
    let in_front = |x: f32| (x - low).min(high - x);
    let (front, next_front) = (in_front(corner[axis]), in_front(corner[axis] + length));
    let is_inside = a >= lattice.iso_level && front > lattice.wall_margin;
    let is_next_inside = b >= lattice.iso_level && next_front > lattice.wall_margin;
    let crosses =
        is_inside && next_front <= lattice.wall_margin || is_next_inside && front <= lattice.wall_margin;
    // From the end that is inside: where the field reaches the iso level, and where the wall is.
    let (outer, depth) = if is_inside { (b, front) } else { (a, next_front) };
    let of_field = if is_inside { t } else { 1.0 - t } * length;
    if !crosses || outer < lattice.iso_level && of_field < depth {
        return None;
    }
    let mut at = corner;
    // The wall on the side of the outer end.
    at[axis] = if is_inside { high } else { low };
    Some((at, if is_inside { Vec3::AXES[axis] } else { -Vec3::AXES[axis] }))
}
