//! Copies a carried quantity that a step does not change back into its persistent array, in the order of the cells: the
//! order that the integration gives to position and velocity.

use glam::Vec4;
use splashdown_gpu::{PassDesc, bindings, wgsl};

use crate::state::{STATE, StepState};

bindings! {
    /// The buffers of `store_carried.wgsl` for one number per particle.
    pub(super) struct ScalarBindings {
        state: read StepState,
        sorted_carried: read [f32],
        carried: write [f32],
    }
}

bindings! {
    /// The buffers of `store_carried.wgsl` for a vector per particle.
    pub(super) struct VectorBindings {
        state: read StepState,
        sorted_carried: read [Vec4],
        carried: write [Vec4],
    }
}

/// One number per particle.
pub static SCALAR: PassDesc = PassDesc {
    label: "cells.store_carried.f32",
    wgsl: include_str!("store_carried.wgsl"),
    imports: &[wgsl::INDEX, STATE],
    entry: "store_carried",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: ScalarBindings::LIST,
    cpu: |_, slots| {
        let ScalarBindings { state, sorted_carried, carried } = slots.into();
        store(state, sorted_carried, carried);
    },
};

/// A vector per particle.
pub static VECTOR: PassDesc = PassDesc {
    label: "cells.store_carried.vec4",
    bindings: VectorBindings::LIST,
    cpu: |_, slots| {
        let VectorBindings { state, sorted_carried, carried } = slots.into();
        store(state, sorted_carried, carried);
    },
    ..SCALAR
};

/// Bound by memory: a plain copy.
fn store<T: Copy>(state: &StepState, sorted: &[T], carried: &mut [T]) {
    let n = state.run_count as usize;
    carried[..n].copy_from_slice(&sorted[..n]);
}
