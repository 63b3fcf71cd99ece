//! Keeps diffuse particles out of bodies, at the end of an update.
//!
//! A particle inside a body, also one that has just been generated there, is moved to the nearest point of its surface and loses the velocity with which it enters the
//! body. Spray that touches a body ages, like spray that touches a side of the domain; it is removed in the next update.
//! A body that is thinner than the distance that a particle travels in one update, or than a cell of its map, does not stop
//! it.

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
        foam_pool: write [Diffuse],
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
