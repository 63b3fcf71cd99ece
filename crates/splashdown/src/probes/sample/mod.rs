//! Pressures at points and heights in columns, from the particles near them; a workgroup per probe.
//!
//! *Pressure.* The mean of the particles' pressures with the kernel's weight (Shepard 1968), carried from their
//! mean place to the point by the gradient that the momentum equation gives, grad p = rho (g - Dv/Dt): without
//! it a gauge in a floor would read the pressure of half a support above. Where there is hardly any fluid the
//! reading fades to zero.
//!
//! *Height.* The fluid's length along the column: the integral of the share of fluid along it, sum V w(r) with
//! a kernel of the distance r from the column whose integral over a plane is one (Wendland C2 in two
//! dimensions). It is what a resistance gauge measures, counts no air under a breaking wave, and is smooth
//! where a highest particle is not. The column is wider than the support, by [`COLUMN`]: at two spacings the
//! lattice that particles rest on would show as three per cent.

mod cpu;

use glam::{Vec2, Vec4};
use splashdown_gpu::{PassDesc, bindings, wgsl};

use super::{PROBE, ProbePoint};
use crate::cells::{GRID, Grid};
use crate::state::{PARAMS, Params, STATE, StepState};

/// Below this share of fluid round a point its pressure fades to zero: a corner of three walls still has an eighth.
pub const WETTED: f32 = 0.1;

/// Radius of a column over the support radius.
pub const COLUMN: f32 = 1.5;

bindings! {
    /// The buffers of `sample.wgsl`.
    pub(super) struct SampleBindings {
        params: uniform Params,
        grid: uniform Grid,
        state: read StepState,
        cell_start: read [u32],
        probes: read [ProbePoint],
        sorted_positions: read [Vec4],
        densities: read [Vec2],
        accelerations: read [Vec4],
        probe_values: write [f32],
    }
}

/// See the module.
pub static SAMPLE: PassDesc = PassDesc {
    label: "probes.sample",
    wgsl: include_str!("sample.wgsl"),
    imports: &[wgsl::INDEX, STATE, PARAMS, GRID, PROBE],
    entry: "sample",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: SampleBindings::LIST,
    cpu: |_, slots| cpu::sample(slots.into()),
};
