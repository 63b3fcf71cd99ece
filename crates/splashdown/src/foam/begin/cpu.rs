use splashdown_gpu::dispatch_groups;

use super::BeginBindings;

pub(super) fn begin(buffers: BeginBindings<'_>) {
    let BeginBindings { foam, state, foam_state, foam_groups: groups } = buffers;
    let now = foam_state;
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
    groups[..3].copy_from_slice(&dispatch_groups(items.div_ceil(64)));
}
