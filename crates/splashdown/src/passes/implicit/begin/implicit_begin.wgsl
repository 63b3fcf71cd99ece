#import sph/params
#import sph/solve

#bindings

@compute @workgroup_size(1)
fn implicit_begin() {
    solve.stopped = select(0u, 1u, state.run_count == 0u);
    solve.iteration = 0u;
    solve.beta = 0.0;
    solve.relaxation = params.relaxation;
    solve.change = 0.0;
    solve.best = 3.4028234e38;
    solve.warm_start = 1.0;
    solve.scale = 1.0;
    solve.renewal = 1.0;
    solve.unused = 0.0;
    solve.unused_2 = 0.0;
    solve.unused_3 = 0.0;
}
