#import sph/step_counters
// Who is in which cell: `cell_counts` holds the number of particles of every cell, the dead's behind the last one,
// and then the cell of every particle. Needs `params`, `grid`, `cell_counts` and `counters`, both atomic.

// The numbers of all cells are zero where counting begins: the sort before has taken every particle off them again.
fn count_particle(i: u32, cell: u32) {
    atomicStore(&cell_counts[grid.cell_count + 1u + i], cell);
    atomicAdd(&cell_counts[cell], 1u);
}

fn is_outside(x: vec3<f32>) -> bool {
    return any(x < params.domain_min) || any(x > params.domain_max);
}
