//! Sets the smoothing weights of vertices on bodies to zero.

mod cpu;

use glam::{Vec2, Vec4};
use splashdown_gpu::{PassDesc, bindings, wgsl};

use crate::bodies::{self, Body};
use crate::surface::modules::{LATTICE, STATUS};
use crate::surface::params::{Lattice, Status};

bindings! {
    /// The buffers of `pin.wgsl`.
    pub(super) struct PinBindings {
        lattice: uniform Lattice,
        status: read Status,
        bodies: read [Body],
        maps: read [Vec2],
        vertex_positions: write [Vec4],
    }
}

pub(crate) static PIN: PassDesc = PassDesc {
    label: "surface.pin",
    wgsl: include_str!("pin.wgsl"),
    imports: &[wgsl::INDEX, STATUS, LATTICE, bodies::BODY, bodies::MAP],
    entry: "pin",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: PinBindings::LIST,
    cpu: |_, slots| cpu::pin(slots.into()),
};
