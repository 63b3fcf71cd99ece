use super::CompactBindings;
use crate::surface::params::NONE;

/// Serial: cheaper than starting threads up to millions of blocks.
pub(super) fn compact(buffers: CompactBindings<'_>) {
    let CompactBindings { lattice, marks, mark_starts, block_list, block_slot } = buffers;
    let blocks = marks.iter().zip(mark_starts).zip(block_slot);
    for (block, ((&mark, &slot), slot_of)) in (0..lattice.block_count).zip(blocks) {
        *slot_of = NONE;
        if mark != 0 && slot < lattice.block_capacity {
            block_list[slot as usize] = block;
            *slot_of = slot;
        }
    }
}
