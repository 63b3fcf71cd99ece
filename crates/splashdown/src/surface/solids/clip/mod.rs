//! Changes the values of the field at nodes near bodies, and their signs.
//!
//! With the distance d of a node from the nearest body, which is negative inside:
//!
//! ```text
//! phi' = min(phi / (1 - D(d)), iso (1 + 0.3 d / cell))
//! ```
//!
//! D is the part of the kernel behind a plane at this distance: the fluid is completed up to the body. The second value
//! is the iso level at the surface of the body, where linear interpolation then places the vertices. It changes slowly,
//! so that the first value is larger at the other end of an edge that crosses the surface.

mod cpu;

use glam::Vec2;
use splashdown_gpu::{PassDesc, bindings, wgsl};

use crate::bodies::{self, Body};
use crate::boundary::{self, KernelPair};
use crate::surface::modules::{LATTICE, STATUS, WALLS};
use crate::surface::params::{Lattice, Status};

bindings! {
    /// The buffers of `clip.wgsl`.
    pub(super) struct ClipBindings {
        lattice: uniform Lattice,
        status: read Status,
        block_list: read [u32],
        bodies: read [Body],
        maps: read [Vec2],
        field_values: write [f32],
        signs: write [u32],
    }
}

pub(crate) static CLIP: PassDesc = PassDesc {
    label: "surface.clip",
    wgsl: include_str!("clip.wgsl"),
    imports: &[wgsl::INDEX, STATUS, LATTICE, WALLS, boundary::PLANES, bodies::BODY, bodies::MAP],
    entry: "clip",
    workgroup_size: [64, 1, 1],
    constants: &[("WALL_KERNEL", KernelPair::CubicSpline.id() as f64)],
    bindings: ClipBindings::LIST,
    cpu: |_, slots| cpu::clip(slots.into()),
};
