//! Counts the particles that crossed the rectangles of flow probes in this step.
//!
//! The path of a particle in a step is a straight line. Every path that intersects a rectangle counts as the volume of
//! one particle, so that no particle is missed or counted twice, whatever the orientation of the rectangle.

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, bindings, wgsl};

use super::{PROBE, ProbePoint};
use crate::cells::{GRID, Grid};
use crate::state::{STATE, StepState};

bindings! {
    /// The buffers of `flux.wgsl`.
    pub(super) struct FluxBindings {
        grid: uniform Grid,
        state: read StepState,
        cell_start: read [u32],
        probes: read [ProbePoint],
        sorted_positions: read [Vec4],
        positions: read [Vec4],
        probe_counts: atomic [u32],
    }
}

/// See the module.
pub static FLUX: PassDesc = PassDesc {
    label: "probes.flux",
    wgsl: include_str!("flux.wgsl"),
    imports: &[wgsl::INDEX, STATE, GRID, PROBE],
    entry: "flux",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: FluxBindings::LIST,
    cpu: |_, slots| cpu::flux(slots.into()),
};
