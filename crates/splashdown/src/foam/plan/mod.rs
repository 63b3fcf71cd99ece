//! How many are left, how many are born, and where these go: behind the others.
//!
//! Where more want to be born than find room, a share of them is, spread evenly over all: taking the first
//! would fill one end of the domain. The rest are counted.

mod cpu;

use splashdown_gpu::{PassDesc, bindings};

use super::{FOAM, FoamParams, FoamState};
use crate::state::{PARAMS, Params, STATE};

bindings! {
    /// The buffers of `plan.wgsl`.
    pub(super) struct PlanBindings {
        params: uniform Params,
        foam: uniform FoamParams,
        foam_starts: read [u32],
        foam_counted: read [u32],
        foam_state: write FoamState,
    }
}

/// See the module.
pub static PLAN: PassDesc = PassDesc {
    label: "foam.plan",
    wgsl: include_str!("plan.wgsl"),
    imports: &[STATE, PARAMS, FOAM],
    entry: "plan",
    workgroup_size: [1, 1, 1],
    constants: &[],
    bindings: PlanBindings::LIST,
    cpu: |_, slots| cpu::plan(slots.into()),
};
