#import gpu/scan_params
#import sph/params
#import sph/solve
#import sph/viscous_state
#import sph/grid
#import sph/suspension

#bindings

// Which step continues here: 0 where the pressure has not stopped, 1 where the viscosity has not, 2 one that was held.
override OF: u32 = 0u;

fn is_due() -> bool {
    switch (OF) {
        case 0u: { return state.done == SUSPENDED && solve.stopped == 0u; }
        case 1u: { return state.done == SUSPENDED && viscous.stopped == 0u; }
        default: { return state.done == HELD; }
    }
}

@compute @workgroup_size(1)
fn resume() {
    if (!is_due()) {
        return;
    }
    cell_start[grid.cell_count] = suspension.cell_particles;
    cell_start[grid.cell_count + 1u] = suspension.all_particles;
    scan_params.len = suspension.scan_len;
    scan_params.blocks = suspension.scan_blocks;
    state.run_count = params.particle_count;
    state.done = 0u;
}
