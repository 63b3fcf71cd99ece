use splashdown_gpu::compact::Compact;

use super::PlanBindings;
use crate::foam::types::place_of;

pub(super) fn plan(buffers: PlanBindings<'_>) {
    let PlanBindings { params, foam, foam_starts: starts, foam_counted: counted, foam_state } = buffers;
    let now = foam_state;
    if now.is_due == 0 {
        now.born = 0;
        return;
    }
    let wanted = starts[params.particle_count as usize];
    let kept = counted[Compact::COUNT_WORD as usize];
    let room = foam.capacity - kept;
    let mut share = 4096;
    if wanted > room {
        // Rounded down, so that the capacity is not exceeded.
        let (mut some, mut all) = (room, wanted);
        while some >= 1 << 20 {
            some >>= 1;
            all = all.div_ceil(2);
        }
        // Below 1/4096: groups of candidates share one slot.
        let mut several = 0;
        while some > 0 && all >> 12 >= some {
            all = all.div_ceil(2);
            several += 1;
        }
        share = (some * 4096 / all) | (several << 16);
    }
    let born = place_of(wanted, share);
    now.kept = kept;
    now.wanted = wanted;
    now.share = share;
    now.born = born;
    now.count = kept + born;
    now.refused = now.refused.saturating_add(wanted - born);
    now.next_id = now.next_id.wrapping_add(born);
}
