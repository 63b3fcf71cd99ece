#import gpu/scan_params
#import sph/state
#import sph/solve
#import sph/viscous_state
#import sph/grid
#import sph/suspension

#bindings

@compute @workgroup_size(1)
fn suspend() {
    if (state.run_count == 0u || (solve.stopped != 0u && viscous.stopped != 0u)) {
        return;
    }
    suspension.cell_particles = cell_start[grid.cell_count];
    suspension.all_particles = cell_start[grid.cell_count + 1u];
    suspension.scan_len = scan_params.len;
    suspension.scan_blocks = scan_params.blocks;
    suspension.count += 1u;
    cell_start[grid.cell_count] = 0u;
    cell_start[grid.cell_count + 1u] = 0u;
    scan_params.len = 0u;
    scan_params.blocks = 0u;
    state.run_count = 0u;
    state.done = SUSPENDED;
}
