use splashdown_gpu::{CpuWork, Slot, dispatch_groups};

use crate::foam::{FoamParams, FoamState};
use crate::state::StepState;

pub(super) fn begin(_: CpuWork, slots: &mut [Slot<'_>]) {
    let [foam, state, foam_state, groups] = slots else { unreachable!() };
    let (foam, state) = (foam.get::<FoamParams>(), state.get::<StepState>());
    let now = &mut foam_state.write::<FoamState>()[0];
    let dt = state.time - now.time;
    let is_sorted = state.run_count != 0;
    let is_late = dt >= foam.interval || state.frame_duration == 0.0;
    now.dt = 0.0;
    now.is_due = 0;
    if now.has_begun == 0 || dt < 0.0 {
        now.has_begun = 1;
        now.time = state.time;
    } else if is_sorted && is_late && dt > 0.0 {
        now.dt = dt;
        now.time = state.time;
        now.is_due = 1;
        now.step = now.step.wrapping_add(1);
    }
    let items = if now.is_due == 1 { now.count } else { 0 };
    groups.write::<u32>()[..3].copy_from_slice(&dispatch_groups(items.div_ceil(64)));
}
