#import sph/step_counters
// `cell_counts` holds the number of particles of every cell, then the number of removed particles, then the cell of
// every particle. Needs `params`, `grid`, and `cell_counts` and `counters`, both atomic.

// All counts are zero before counting: the previous sort has decremented them.
fn count_particle(i: u32, cell: u32) {
    atomicStore(&cell_counts[grid.cell_count + 1u + i], cell);
    atomicAdd(&cell_counts[cell], 1u);
}

fn is_outside(x: vec3<f32>) -> bool {
    return any(x < params.domain_min) || any(x > params.domain_max);
}
