use splashdown_gpu::dispatch_groups;

use super::PlanBindings;

pub(super) fn plan(buffers: PlanBindings<'_>) {
    let PlanBindings { lattice, mark_starts, status, block_groups } = buffers;
    let needed = mark_starts[lattice.block_count as usize];
    let blocks = needed.min(lattice.block_capacity);
    status.blocks = blocks;
    status.blocks_needed = needed;
    block_groups[..3].copy_from_slice(&dispatch_groups(blocks));
}
