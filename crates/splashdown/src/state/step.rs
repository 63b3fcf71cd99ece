//! What changes from step to step.

use splashdown_gpu::{WgslModule, gpu_struct};

/// The WGSL side of [`StepState`].
pub const WGSL: WgslModule = WgslModule { name: "sph/state", source: include_str!("state.wgsl") };
/// `finish_step`: the end of a step; imports [`STEP_COUNTERS`](super::STEP_COUNTERS).
pub const STEPS: WgslModule = WgslModule { name: "sph/steps", source: include_str!("steps.wgsl") };

gpu_struct! {
    /// What changes from step to step; decided on the device.
    pub struct StepState {
        /// The current time step in seconds.
        dt: f32,
        /// The time step that stability asks for; `dt` may be shorter to meet the end of a frame.
        stable_dt: f32,
        /// Simulated time in seconds.
        time: f32,
        /// What is left of the frame in seconds.
        remaining: f32,
        /// 1 once the frame is complete: the passes do nothing then.
        done: u32,
        /// Particles to process: all, or none once the frame is complete.
        run_count: u32,
        /// Steps of this frame.
        steps: u32,
        /// 1 if stability asked for less than `min_dt` in this frame; `min_dt` was taken then.
        too_small: u32,
        /// Largest speed of the last step in m/s.
        max_speed: f32,
        /// Largest acceleration of the last step in m/s^2.
        max_acceleration: f32,
        /// Largest relative excess of density in this frame.
        density_error: f32,
        /// Length of the frame in seconds.
        frame_duration: f32,
    }
}

impl StepState {
    /// The length of a step: what is left of the frame is split evenly, so that no tiny step is left over.
    pub fn step_length(stable: f32, remaining: f32) -> f32 {
        if remaining >= 2.0 * stable {
            stable
        } else if remaining <= stable {
            remaining
        } else {
            0.5 * remaining
        }
    }

    /// True of the step that completes its frame. Both numbers are stored, so all passes decide alike.
    pub fn is_last_step(&self) -> bool {
        self.dt >= self.remaining
    }
}
