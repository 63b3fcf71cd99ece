#import gpu/scan_params
#import sph/state
#import sph/solve
#import sph/viscous_state
#import sph/grid
#import sph/suspension

#bindings

// Which step ends here: 0 where the pressure has not stopped, 1 where the viscosity has not, 2 any.
override OF: u32 = 0u;

fn has_stopped() -> bool {
    switch (OF) {
        case 0u: { return solve.stopped != 0u; }
        case 1u: { return viscous.stopped != 0u; }
        default: { return false; }
    }
}

@compute @workgroup_size(1)
fn suspend() {
    if (state.done != 0u || has_stopped()) {
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
    state.done = select(SUSPENDED, HELD, OF == 2u);
}
