#import sph/params
#import sph/foam

#bindings

@compute @workgroup_size(1)
fn plan() {
    if (foam_state.is_due == 0u) {
        foam_state.born = 0u;
        return;
    }
    let wanted = foam_starts[params.particle_count];
    let kept = foam_counted[3];
    let room = foam.capacity - kept;
    var share = 4096u;
    if (wanted > room) {
        // Rounded down, so that the capacity is not exceeded.
        var some = room;
        var all = wanted;
        while (some >= 1048576u) {
            some = some >> 1u;
            all = (all + 1u) >> 1u;
        }
        // Below 1/4096: groups of candidates share one slot.
        var several = 0u;
        while (some > 0u && (all >> 12u) >= some) {
            all = (all + 1u) >> 1u;
            several++;
        }
        share = (some * 4096u / all) | (several << 16u);
    }
    let born = place_of(wanted, share);
    foam_state.kept = kept;
    foam_state.wanted = wanted;
    foam_state.share = share;
    foam_state.born = born;
    foam_state.count = kept + born;
    foam_state.refused += wanted - born;
    foam_state.next_id += born;
}
