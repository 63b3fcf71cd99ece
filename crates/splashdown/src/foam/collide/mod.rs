//! Keeps diffuse particles out of bodies.
//!
//! A particle inside a body is moved to the nearest point of its surface and loses the velocity with which it enters the
//! body. Spray that touches a body ages, like spray that touches a side of the domain. A body that is thinner than the way
//! of a particle in one update, 2 cm at 5 m/s, does not stop it.

mod cpu;

use glam::Vec2;
use splashdown_gpu::{PassDesc, bindings, wgsl};

use super::{Diffuse, FOAM, FoamState};
use crate::bodies::{self, Body};

bindings! {
    /// The buffers of `collide.wgsl`.
    pub(super) struct CollideBindings {
        foam_state: read FoamState,
        bodies: read [Body],
        maps: read [Vec2],
        foam_moved: write [Diffuse],
        foam_alive: write [u32],
    }
}

/// See the module.
pub static COLLIDE: PassDesc = PassDesc {
    label: "foam.collide",
    wgsl: include_str!("collide.wgsl"),
    imports: &[wgsl::INDEX, FOAM, bodies::BODY, bodies::MAP],
    entry: "collide",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: CollideBindings::LIST,
    cpu: |_, slots| cpu::collide(slots.into()),
};
