#import gpu/scan_params
#import sph/params
#import sph/solve
#import sph/viscous_state
#import sph/grid
#import sph/suspension

#bindings

// 1 before the iterations of the viscosity, 0 before those of the pressure.
override OF_VISCOSITY: u32 = 0u;

@compute @workgroup_size(1)
fn resume() {
    let has_stopped = select(solve.stopped, viscous.stopped, OF_VISCOSITY == 1u) != 0u;
    if (state.done != SUSPENDED || has_stopped) {
        return;
    }
    cell_start[grid.cell_count] = suspension.cell_particles;
    cell_start[grid.cell_count + 1u] = suspension.all_particles;
    scan_params.len = suspension.scan_len;
    scan_params.blocks = suspension.scan_blocks;
    state.run_count = params.particle_count;
    state.done = 0u;
}
