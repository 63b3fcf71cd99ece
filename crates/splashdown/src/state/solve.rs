//! The state of the implicit pressure solver.

use splashdown_gpu::{WgslModule, gpu_struct};

use super::Params;

/// The WGSL side of [`SolveState`].
pub const WGSL: WgslModule = WgslModule { name: "sph/solve", source: include_str!("solve.wgsl") };

gpu_struct! {
    /// What the iterations of the implicit pressure share. It is computed on the device.
    pub struct SolveState {
        /// 1 once the iterations of this step have ended.
        stopped: u32,
        /// Iterations of this step.
        iteration: u32,
        /// Factor of the previous direction in the next one; 0 restarts.
        beta: f32,
        /// Relaxation of the Jacobi map.
        relaxation: f32,
        /// Squared length of the last change of the pressure, in the norm of the diagonal.
        change: f32,
        /// The smallest mean residual of this step.
        best: f32,
        /// Factor of the pressure with which the next step starts.
        warm_start: f32,
        /// Factor of the accepted pressure for which its work vanishes that the residual accounts for.
        scale: f32,
        /// Part of the new pressure in the pressure with which the next step starts.
        renewal: f32,
        /// Length of the step over that of the longest one without the limits by the pressure and by the frame; at most 1.
        dt_ratio: f32,
        /// Length of the step over the length that the pressure was solved for; below 1 if it stops much of the fluid.
        advanced_part: f32,
        /// The mean excess of density that is accepted in this step, where fluid fills a closed domain.
        mean_excess: f32,
    }
}

impl SolveState {
    /// Marks a particle whose motion a nozzle determines, instead of a pressure.
    pub const NO_PRESSURE: f32 = -1e30;

    /// True in the first iteration of a step where fluid fills a closed domain. It keeps the pressures, and measures the mean
    /// excess of density.
    pub fn is_measuring(&self, params: &Params) -> bool {
        params.accepted_excess > 0.0 && self.iteration == 0
    }

    /// The state at the beginning of a step, with the relaxation of the Jacobi map and the relative length of the step.
    pub fn new(is_stopped: bool, relaxation: f32, dt_ratio: f32) -> Self {
        Self {
            stopped: u32::from(is_stopped),
            iteration: 0,
            beta: 0.0,
            relaxation,
            change: 0.0,
            best: f32::MAX,
            warm_start: 1.0,
            scale: 1.0,
            renewal: 1.0,
            dt_ratio,
            advanced_part: 1.0,
            mean_excess: 0.0,
        }
    }
}
