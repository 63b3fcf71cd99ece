use splashdown_gpu::{CpuWork, Slot};

use crate::surface::params::{Lattice, NONE};

/// Serial: cheaper than starting threads up to millions of blocks.
pub(super) fn compact(_: CpuWork, slots: &mut [Slot<'_>]) {
    let [lattice, marks, starts, list, slot_of] = slots else { unreachable!() };
    let lattice = lattice.get::<Lattice>();
    let (list, slot_of) = (list.write::<u32>(), slot_of.write::<u32>());
    let blocks = marks.read::<u32>().iter().zip(starts.read::<u32>()).zip(slot_of);
    for (block, ((&mark, &slot), slot_of)) in (0..lattice.block_count).zip(blocks) {
        *slot_of = NONE;
        if mark != 0 && slot < lattice.block_capacity {
            list[slot as usize] = block;
            *slot_of = slot;
        }
    }
}
