use splashdown_gpu::{CpuWork, Slot, dispatch_groups};

use crate::surface::params::{Lattice, Status};

pub(super) fn plan(_: CpuWork, slots: &mut [Slot<'_>]) {
    let [lattice, starts, status, groups] = slots else { unreachable!() };
    let lattice = lattice.get::<Lattice>();
    let needed = starts.read::<u32>()[lattice.block_count as usize];
    let blocks = needed.min(lattice.block_capacity);
    let status = &mut status.write::<Status>()[0];
    status.blocks = blocks;
    status.blocks_needed = needed;
    groups.write::<u32>()[..3].copy_from_slice(&dispatch_groups(blocks));
}
