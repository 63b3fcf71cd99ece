//! Measures pressures at points and heights in columns from the particles near them; one workgroup per probe.
//!
//! *Pressure.* The kernel-weighted mean of the particles' pressures (Shepard 1968), extrapolated from the weighted mean
//! position to the point with the gradient of the momentum equation, grad p = rho (g - Dv/Dt). Without it a gauge in a
//! floor would measure the pressure half a support radius above. Where there is little fluid the value decreases to
//! zero.
//!
//! *Height.* The length of fluid along the column: the integral of the volume fraction along it, sum V w(r), with a
//! kernel of the distance r from the axis whose integral over a plane is one (Wendland C2 in two dimensions). This is
//! the quantity that a resistance gauge measures. It excludes air under a breaking wave and, unlike the position of the
//! highest particle, is smooth in time. The column is wider than the support radius, by [`COLUMN`]: at two spacings the
//! lattice of the particles would cause an error of three per cent.

mod cpu;

use glam::{Vec2, Vec4};
use splashdown_gpu::{PassDesc, bindings, wgsl};

use super::{PROBE, ProbePoint};
use crate::cells::{GRID, Grid};
use crate::state::{PARAMS, Params, STATE, StepState};

/// The volume fraction of fluid below which the pressure at a point decreases to zero. In a corner of three walls the
/// fraction is an eighth.
pub const WETTED: f32 = 0.1;

/// The radius of a column over the support radius.
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
