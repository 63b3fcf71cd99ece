use super::KeptCellsBindings;

/// Serial: a load and a store per cell.
pub(super) fn kept_cells(buffers: KeptCellsBindings<'_>) {
    let KeptCellsBindings { lattice, grid, cell_start, kept_starts, kept_cell_start, droplet_count } =
        buffers;
    let first = |cell: usize| cell_start[cell].min(lattice.particle_capacity);
    let cells = grid.cell_count as usize;
    for (cell, start) in kept_cell_start[..=cells].iter_mut().enumerate() {
        *start = kept_starts[first(cell) as usize];
    }
    droplet_count[0] = first(cells) - kept_cell_start[cells];
}
