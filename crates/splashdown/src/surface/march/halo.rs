//! The nodes of adjacent blocks, on the CPU.

use crate::surface::params::{Lattice, NONE};

/// The slots of a block (first) and of the seven adjacent blocks towards higher coordinates. Block
/// `(dx, dy, dz)` has the index `dx + 2 dy + 4 dz`.
pub(super) fn upper_slots(lattice: &Lattice, slot_of: &[u32], place: [i32; 3]) -> [u32; 8] {
    std::array::from_fn(|i| {
        let i = i as i32;
        let at = [place[0] + (i & 1), place[1] + (i >> 1 & 1), place[2] + (i >> 2)];
        lattice.block_at(at).map_or(NONE, |block| slot_of[block])
    })
}

/// The signs of the nodes of the block and of one more layer on the upper sides: one bit per x, by
/// z and y. `sign_bits` returns the eight bits of a row.
pub(super) fn signs(slots: &[u32; 8], sign_bits: impl Fn(usize) -> u32) -> [[u32; 9]; 9] {
    let bits = |slot: u32, row: usize| if slot == NONE { 0 } else { sign_bits(slot as usize * 64 + row) };
    std::array::from_fn(|z| {
        std::array::from_fn(|y| {
            let pair = 2 * (y >> 3) + 4 * (z >> 3);
            let row = (y & 7) + 8 * (z & 7);
            bits(slots[pair], row) | (bits(slots[pair + 1], row) & 1) << 8
        })
    })
}

/// The marching-cubes case of the cell at (x, y, z).
pub(super) fn cell_case(signs: &[[u32; 9]; 9], x: usize, y: usize, z: usize) -> usize {
    let pair = |y: usize, z: usize| (signs[z][y] >> x & 3) as usize;
    pair(y, z) | pair(y + 1, z) << 2 | pair(y, z + 1) << 4 | pair(y + 1, z + 1) << 6
}

/// True if no edge of the block is cut.
pub(super) fn is_uniform(signs: &[[u32; 9]; 9]) -> bool {
    let first = signs[0][0];
    (first == 0 || first == 0x1ff) && signs.as_flattened().iter().all(|&row| row == first)
}
