//! Puts those that are left together, in their order.

mod cpu;

use splashdown_gpu::{PassDesc, read, wgsl, write};

use super::{Diffuse, FOAM, FoamState};

/// See the module.
pub static SETTLE: PassDesc = PassDesc {
    label: "foam.settle",
    wgsl: include_str!("settle.wgsl"),
    imports: &[wgsl::INDEX, FOAM],
    entry: "settle",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: &[
        read::<FoamState>("foam_state"),
        read::<u32>("indices"),
        read::<Diffuse>("moved"),
        write::<Diffuse>("pool"),
    ],
    cpu: cpu::settle,
};
