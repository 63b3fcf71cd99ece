//! Accumulates the values of the probes since their last row, and writes a row when it is due; one invocation per probe.
//!
//! A row is the mean over the time since the previous row. A mean preserves impulses exactly for any interval, and
//! averages out the pressure oscillations of sound waves. The pose and the velocity of a body are those at the end of the
//! step that writes the row, after the motion of the bodies.

mod cpu;

use splashdown_gpu::{PassDesc, bindings, wgsl};

use super::{PROBE, ProbePoint};
use crate::bodies::{BODY, Body};
use crate::state::{PARAMS, Params, STATE, StepState};

bindings! {
    /// The buffers of `accumulate.wgsl`.
    pub(super) struct AccumulateBindings {
        params: uniform Params,
        state: read StepState,
        probes: read [ProbePoint],
        bodies: read [Body],
        probe_values: read [f32],
        probe_counts: write [u32],
        probe_accounts: write [u32],
        probe_rows: write [f32],
    }
}

/// See the module.
pub static ACCUMULATE: PassDesc = PassDesc {
    label: "probes.accumulate",
    wgsl: include_str!("accumulate.wgsl"),
    imports: &[wgsl::INDEX, STATE, PARAMS, BODY, PROBE],
    entry: "accumulate",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: AccumulateBindings::LIST,
    cpu: |_, slots| cpu::accumulate(slots.into()),
};
