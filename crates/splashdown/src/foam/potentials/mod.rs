//! The three potentials of each fluid particle to generate foam (Ihmsen et al. 2012, section 3.1).
//!
//! *Trapped air*, in m/s: sum_j V |v_ij| (1 - v_ij/|v_ij| . x_ij/|x_ij|) W(x_ij), V =
//! particle_spacing^3. Pairs on a direct approach count twice, separating pairs not at all.
//!
//! *Wave crest*, dimensionless: sum_j V (1 - n_i . n_j) W(x_ij) over the surface particles j behind
//! the surface of i (x_ji . n_i < 0), if i moves along its normal (v . n >= 0.6 |v|).
//!
//! *Energy*, in J/kg: v^2 / 2. The paper uses joules; per mass, the limits are independent of the
//! resolution.
//!
//! The paper uses the weight 1 - r/H without normalisation, so that its sums grow with the number
//! of neighbours; a kernel times a volume does not. Particles that are too slow to generate foam
//! are skipped: their first two potentials are 0.

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, bindings, wgsl};

use super::{FOAM, FoamParams, FoamState};
use crate::cells::{GRID, Grid, ROWS};
use crate::kernel;
use crate::state::{PARAMS, Params, STATE};

bindings! {
    /// The buffers of `potentials.wgsl`.
    pub(super) struct PotentialsBindings {
        params: uniform Params,
        grid: uniform Grid,
        foam: uniform FoamParams,
        foam_state: read FoamState,
        cell_start: read [u32],
        sorted_positions: read [Vec4],
        sorted_velocities: read [Vec4],
        foam_normals: read [Vec4],
        foam_potentials: write [Vec4],
    }
}

/// See the module.
pub static POTENTIALS: PassDesc = PassDesc {
    label: "foam.potentials",
    wgsl: include_str!("potentials.wgsl"),
    imports: &[wgsl::INDEX, STATE, PARAMS, GRID, ROWS, kernel::WGSL, FOAM],
    entry: "potentials",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: PotentialsBindings::LIST,
    cpu: |_, slots| cpu::potentials(slots.into()),
};
