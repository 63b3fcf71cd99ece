//! Ends a step: reads and resets the maxima, and computes the next time step on the device.
//!
//! With h = H / 2: dt = min(C h / (c0 + |v|max), max(C, 0.9) h / (c + |v|max), C sqrt(h / |a|max), 0.4 spacing C / |v|max,
//! 0.125 h^2 / nu, 0.17 h / (delta c0), max_dt) (Monaghan 1992; Morris, Fox & Zhu 1997), at most a tenth more than the last.
//! c = c0 (rho_max / rho0)^((exponent - 1) / 2) is the speed of sound in the densest fluid. The maxima
//! are those of the step that ends, so the time step lags by one step; velocities are limited for this reason.
//! [`Params::step_length`] divides the remaining time of the frame.
//!
//! With implicit pressure neither sound nor accelerations limit the step:
//! dt = min(C spacing / |v|max, spacing / 2 sqrt(rho0 / p), 0.125 h^2 / nu, max_dt), at most half more than the last,
//! and 0.7 times the last if the pressure or the viscosity did not converge. p is the largest mean of the pressure over the
//! steps ([`finish`](crate::passes::implicit::finish)). The limit by the pressure keeps the step stable: the pressure forces of a step have the directions at its start, and the force on a particle that is displaced
//! across its neighbours grows with the pressure and with the displacement. In trials in two dimensions a factor of 0.6
//! was stable at depths of 20 to 80 spacings, and 0.8 was not.
//!
//! The limit by the density diffusion delta keeps its explicit integration stable: the shortest wave decays at a rate of
//! about 14 delta c0 / H, from the sum of 2 V |dW/dr| / r over the neighbours, and the limit makes this 1.2 / dt. It acts
//! where delta exceeds 0.17 / C.
//!
//! [`StepCounters::MOVED`] marks a step that has not ended yet, so ending it twice has no effect. The pass of this
//! module runs once per submission; inside one, the next step's [`scatter`](crate::cells) ends the step before
//! it, which saves a dispatch per step: no earlier pass of a step reads the state.

mod cpu;

use splashdown_gpu::{DispatchSize, PassDesc, Recording, bindings};

#[cfg(doc)]
use super::StepCounters;
use super::{Fields, PARAMS, Params, STATE, STEP_COUNTERS, STEPS, StepState};

pub(crate) use cpu::finish_step;

bindings! {
    /// The buffers of `end_step.wgsl`.
    pub(super) struct EndStepBindings {
        params: uniform Params,
        state: write StepState,
        counters: write [u32],
    }
}

/// See the module.
pub static END_STEP: PassDesc = PassDesc {
    label: "end_step",
    wgsl: include_str!("end_step.wgsl"),
    imports: &[STATE, PARAMS, STEP_COUNTERS, STEPS],
    entry: "end_step",
    workgroup_size: [1, 1, 1],
    constants: &[],
    bindings: EndStepBindings::LIST,
    cpu: |_, slots| cpu::end_step(slots.into()),
};

/// Ends the last step of a submission. Afterwards the host, or passes of another step, may read the state.
pub fn record(fields: &Fields) -> Recording {
    let mut recording = Recording::new("end_step");
    recording.dispatch(&END_STEP, DispatchSize::Groups(1), &fields.buffers());
    recording
}
