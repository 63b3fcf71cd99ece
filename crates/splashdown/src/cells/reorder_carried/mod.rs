//! Copies a carried quantity into the order of the cells, as [`reorder`](super::reorder) does with position and
//! velocity, and resets it for removed particles to the value of an emitted one, because emitters reuse their entries.
//! Once for each quantity with [`Update::Constant`](crate::state::Update::Constant) or
//! [`Update::Evolved`](crate::state::Update::Evolved).

mod cpu;

use glam::{UVec2, Vec4};
use splashdown_gpu::{PassDesc, bindings, wgsl};

use super::{GRID, Grid, PLACE};

bindings! {
    /// The buffers of `reorder_carried.wgsl` for one number per particle.
    pub(super) struct ScalarBindings {
        grid: uniform Grid,
        cell_counts: read [u32],
        cell_start: read [u32],
        entries: read [UVec2],
        carried: read [f32],
        emitted: read [f32],
        sorted_carried: write [f32],
    }
}

bindings! {
    /// The buffers of `reorder_carried.wgsl` for a vector per particle.
    pub(super) struct VectorBindings {
        grid: uniform Grid,
        cell_counts: read [u32],
        cell_start: read [u32],
        entries: read [UVec2],
        carried: read [Vec4],
        emitted: read [Vec4],
        sorted_carried: write [Vec4],
    }
}

/// One number per particle.
pub static SCALAR: PassDesc = PassDesc {
    label: "cells.reorder_carried.f32",
    wgsl: include_str!("reorder_carried.wgsl"),
    imports: &[wgsl::INDEX, GRID, PLACE],
    entry: "reorder_carried",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: ScalarBindings::LIST,
    cpu: |_, slots| {
        let ScalarBindings { grid, cell_start, entries, carried, emitted, sorted_carried, .. } = slots.into();
        cpu::reorder_carried(grid, cell_start, entries, carried, sorted_carried);
        cpu::reset_removed(grid, cell_start, emitted, sorted_carried);
    },
};

/// A vector per particle.
pub static VECTOR: PassDesc = PassDesc {
    label: "cells.reorder_carried.vec4",
    bindings: VectorBindings::LIST,
    cpu: |_, slots| {
        let VectorBindings { grid, cell_start, entries, carried, emitted, sorted_carried, .. } = slots.into();
        cpu::reorder_carried(grid, cell_start, entries, carried, sorted_carried);
        cpu::reset_removed(grid, cell_start, emitted, sorted_carried);
    },
    ..SCALAR
};
