#import sph/state
#import sph/viscous_state

#bindings

@compute @workgroup_size(1)
fn viscous_begin() {
    viscous.stopped = select(0u, 1u, state.run_count == 0u);
    viscous.iteration = 0u;
    viscous.updates = 0u;
    viscous.alpha = 0.0;
    viscous.beta = 0.0;
    viscous.gamma = 0.0;
    viscous.reference = 0.0;
    viscous.target_residual = 0.0;
}
