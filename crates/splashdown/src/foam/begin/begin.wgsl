#import gpu/index
#import sph/state
#import sph/foam

@group(0) @binding(0) var<uniform> foam: FoamParams;
@group(0) @binding(1) var<storage, read> state: StepState;
@group(0) @binding(2) var<storage, read_write> foam_state: FoamState;
@group(0) @binding(3) var<storage, read_write> groups: array<u32>;

@compute @workgroup_size(1)
fn begin_foam() {
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
    groups[0] = args.x;
    groups[1] = args.y;
    groups[2] = args.z;
}
