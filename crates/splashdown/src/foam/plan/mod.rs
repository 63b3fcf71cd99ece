//! The number of remaining and of new particles. New particles are appended to the remaining ones.
//!
//! If there are more candidates than free slots, an evenly distributed fraction of them is
//! accepted; accepting the first ones would fill one end of the domain. The rejected candidates are
//! counted.

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
