//! Sums what the probes read over the time since their last row, and writes a row when it is due; an invocation
//! per probe.
//!
//! A row is the mean over the time since the row before: a mean keeps impulses exact whatever the interval, and
//! what sound adds to the pressures of one step is not mistaken for the fluid's.

mod cpu;

use splashdown_gpu::{PassDesc, read, uniform, wgsl, write};

use super::{PROBE, ProbePoint};
use crate::bodies::{BODY, Body};
use crate::state::{PARAMS, Params, STATE, StepState};

/// See the module.
pub static ACCUMULATE: PassDesc = PassDesc {
    label: "probes.accumulate",
    wgsl: include_str!("accumulate.wgsl"),
    imports: &[wgsl::INDEX, STATE, PARAMS, BODY, PROBE],
    entry: "log_values",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: &[
        uniform::<Params>("params"),
        read::<StepState>("state"),
        read::<ProbePoint>("probes"),
        read::<Body>("bodies"),
        read::<f32>("values"),
        write::<u32>("counts"),
        write::<u32>("accounts"),
        write::<f32>("rows"),
    ],
    cpu: cpu::accumulate,
};
