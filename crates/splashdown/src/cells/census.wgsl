#import sph/tally
// Who is in which cell: `census` holds the number of particles of every cell, the dead's behind the last one,
// and then the cell of every particle. Needs `params`, `grid`, `census` and `tally`, both atomic.

// The numbers of all cells are zero where counting begins: the sort before has taken every particle off them again.
fn enroll(i: u32, cell: u32) {
    atomicStore(&census[grid.cell_count + 1u + i], cell);
    atomicAdd(&census[cell], 1u);
}

fn is_outside(x: vec3<f32>) -> bool {
    return any(x < params.domain_min) || any(x > params.domain_max);
}
