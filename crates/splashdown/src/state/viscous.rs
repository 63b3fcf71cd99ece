//! The state of the implicit viscosity.

use splashdown_gpu::{WgslModule, gpu_struct};

/// The WGSL side of [`ViscousState`].
pub const WGSL: WgslModule = WgslModule { name: "sph/viscous_state", source: include_str!("viscous.wgsl") };

gpu_struct! {
    /// What the iterations of the implicit viscosity share. It is computed on the device.
    pub struct ViscousState {
        /// 1 once the iterations of this step have ended.
        stopped: u32,
        /// Iterations of this step.
        iteration: u32,
        /// How often the velocities were changed.
        updates: u32,
        /// Length of the present change along its direction.
        alpha: f32,
        /// Factor of the previous direction in the present one.
        beta: f32,
        /// The product of the last residual with its preconditioned form, in m^2/s^2.
        gamma: f32,
        /// The root mean square in m/s to which the residual is compared.
        reference: f32,
        /// The root mean square of the residual in m/s at which the iterations stop.
        target_residual: f32,
    }
}

impl ViscousState {
    /// The state at the beginning of a step.
    pub fn new(is_stopped: bool) -> Self {
        Self { stopped: u32::from(is_stopped), ..bytemuck::Zeroable::zeroed() }
    }
}
