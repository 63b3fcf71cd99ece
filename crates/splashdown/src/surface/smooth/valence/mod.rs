//! Counts the triangles of every vertex.

mod cpu;

use splashdown_gpu::{PassDesc, read, wgsl, write};

use crate::surface::modules::STATUS;
use crate::surface::params::Status;

pub(crate) static VALENCE: PassDesc = PassDesc {
    label: "surface.valence",
    wgsl: include_str!("valence.wgsl"),
    imports: &[wgsl::INDEX, STATUS],
    entry: "valence",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: &[read::<Status>("status"), read::<u32>("indices"), write::<u32>("valences")],
    cpu: cpu::valence,
};
