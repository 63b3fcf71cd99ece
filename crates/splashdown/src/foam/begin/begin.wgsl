#import gpu/index
#import sph/state
#import sph/foam

#bindings

@compute @workgroup_size(1)
fn begin() {
    let dt = state.time - foam_state.time;
    let is_sorted = state.run_count != 0u;
    let is_late = dt >= foam.interval || state.frame_duration == 0.0;
    foam_state.dt = 0.0;
    foam_state.is_due = 0u;
    if (foam_state.has_begun == 0u || dt < 0.0) {
        foam_state.has_begun = 1u;
        foam_state.time = state.time;
    } else if (is_sorted && is_late && dt > 0.0) {
        foam_state.dt = dt;
        foam_state.time = state.time;
        foam_state.is_due = 1u;
        foam_state.step += 1u;
    }
    let items = select(0u, foam_state.count, foam_state.is_due == 1u);
    let args = dispatch_groups((items + 63u) / 64u);
    foam_groups[0] = args.x;
    foam_groups[1] = args.y;
    foam_groups[2] = args.z;
}
