//! How many are left, how many are born, and where these go: behind the others.
//!
//! Where more want to be born than find room, a share of them is, spread evenly over all: taking the first
//! would fill one end of the domain. The rest are counted.

mod cpu;

use splashdown_gpu::{PassDesc, read, uniform, write};

use super::{FOAM, FoamParams, FoamState};
use crate::state::{PARAMS, Params, STATE};

/// See the module.
pub static PLAN: PassDesc = PassDesc {
    label: "foam.plan",
    wgsl: include_str!("plan.wgsl"),
    imports: &[STATE, PARAMS, FOAM],
    entry: "plan_foam",
    workgroup_size: [1, 1, 1],
    constants: &[],
    bindings: &[
        uniform::<Params>("params"),
        uniform::<FoamParams>("foam"),
        read::<u32>("starts"),
        read::<u32>("counted"),
        write::<FoamState>("foam_state"),
    ],
    cpu: cpu::plan,
};
