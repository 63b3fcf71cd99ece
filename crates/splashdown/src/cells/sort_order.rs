//! The sort by cell on the host, for particles that are in no buffer.

use glam::Vec3;

use super::Grid;

/// The indices of the particles in a stable counting sort by cell, and the first of each cell.
pub(crate) fn sort_order(grid: &Grid, positions: &[Vec3]) -> (Vec<u32>, Vec<u32>) {
    let cells: Vec<u32> = positions.iter().map(|&p| grid.cell_of(p)).collect();
    let mut start = vec![0_u32; grid.cell_count as usize + 1];
    for &cell in &cells {
        start[cell as usize + 1] += 1;
    }
    for cell in 1..start.len() {
        start[cell] += start[cell - 1];
    }
    let mut next = start.clone();
    let mut order = vec![0; positions.len()];
    for (particle, &cell) in cells.iter().enumerate() {
        let place = &mut next[cell as usize];
        order[*place as usize] = particle as u32;
        *place += 1;
    }
    (order, start)
}
