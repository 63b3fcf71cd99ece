use glam::{UVec4, Vec3, Vec4Swizzles};
use rayon::prelude::*;

use super::ListBindings;
use crate::boundary::{Images, Reflection};
use crate::pairs::Sorted;

/// As in `neighbour_entries.wgsl`.
const INDEX_BITS: u32 = 27;
const NO_NEIGHBOUR: u32 = 31;
const BY_ROWS: u32 = 0x8000_0000;

/// Only tests allocate layers on the CPU.
pub(super) fn list_neighbours(buffers: ListBindings<'_>) {
    let ListBindings { params, grid, cell_start, sorted_positions: positions, neighbours } = buffers;
    let n = params.particle_count as usize;
    let layers = neighbours.len() / n.max(1);
    if layers == 0 {
        return;
    }
    let images = Images::new(params);
    let reach = params.support_radius;
    let sorted = Sorted::new(reach, grid, cell_start, positions);
    let words_of = |i: usize| {
        let x = positions[i].xyz();
        let runs = sorted.runs_around_point(x);
        let mut words = vec![0];
        let mut visit = |image: u32, own: Vec3| {
            for j in runs.iter().cloned().flatten() {
                if (own - positions[j].xyz()).length_squared() < reach * reach {
                    words.push(image << INDEX_BITS | j as u32);
                }
            }
        };
        visit(0, x);
        for by in images.near(x, x, reach) {
            visit(number_of(&by, params.domain_min), by.sign * x + by.shift);
        }
        words[0] = words.len() as u32 - 1;
        if words.len() > 4 * layers {
            return vec![BY_ROWS];
        }
        words.resize(words.len().next_multiple_of(4), NO_NEIGHBOUR << INDEX_BITS | i as u32);
        words
    };
    let lists: Vec<Vec<u32>> = (0..sorted.active_count()).into_par_iter().map(words_of).collect();
    for (i, words) in lists.iter().enumerate() {
        if let [BY_ROWS] = words[..] {
            neighbours[i].x = BY_ROWS;
        }
        for (layer, four) in words.chunks_exact(4).enumerate() {
            neighbours[layer * n + i] = UVec4::from_slice(four);
        }
    }
}

/// The number whose digits of base 3 are 0 for no reflection, 1 for the lower side and 2 for the upper side of an axis.
fn number_of(by: &Reflection, domain_min: Vec3) -> u32 {
    let digit = |axis: usize| match by.sign[axis] < 0.0 {
        false => 0,
        true if by.shift[axis] == 2.0 * domain_min[axis] => 1,
        true => 2,
    };
    digit(0) + 3 * digit(1) + 9 * digit(2)
}
