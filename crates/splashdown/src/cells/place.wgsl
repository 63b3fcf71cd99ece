// Where the sort puts a particle; needs `grid`, `cell_counts`, `cell_start` and `entries`.

// The order of removed particles behind the last cell does not matter. More than this many keep the order of their
// entries: they may be all particles, and comparing each with each would hang the device.
const MOST_REMOVED_IN_ORDER: u32 = 1024u;

// The sorted index of entry `k`, whose particle has the index `i` and the id `id`.
fn sorted_index(k: u32, i: u32, id: u32) -> u32 {
    let cell = cell_counts[grid.cell_count + 1u + i];
    let begin = cell_start[cell];
    let end = cell_start[cell + 1u];
    if (cell == grid.cell_count && end - begin > MOST_REMOVED_IN_ORDER) {
        return k;
    }
    var index = begin;
    for (var m = begin; m < end; m++) {
        index += u32(entries[m].x < id);
    }
    return index;
}
