//! Ends a step: takes the maxima, and chooses the next time step on the device.
//!
//! With h = H / 2: dt = min(C h / (c0 + |v|max), C sqrt(h / |a|max), 0.4 spacing C / |v|max, 0.125 h^2 / nu, max_dt)
//! (Monaghan 1992; Morris, Fox & Zhu 1997), at most a tenth more than the last. The maxima are those of the step that
//! ends, so the choice is one step late; the limit on velocities of half a spacing per step catches the rest. Near the
//! end of the frame the rest is split evenly, so that no tiny step is left over.

mod cpu;

use splashdown_gpu::{PassDesc, uniform, write};

use super::{PARAMS, Params, STATE, StepState, TALLY};

/// See the module.
pub static CFL: PassDesc = PassDesc {
    label: "cfl",
    wgsl: include_str!("cfl.wgsl"),
    imports: &[STATE, PARAMS, TALLY],
    entry: "cfl",
    workgroup_size: [1, 1, 1],
    constants: &[],
    bindings: &[uniform::<Params>("params"), write::<StepState>("state"), write::<u32>("tally")],
    cpu: cpu::cfl,
};
