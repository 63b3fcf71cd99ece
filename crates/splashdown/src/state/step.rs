//! The state of a step.

use splashdown_gpu::{WgslModule, gpu_struct};

/// The WGSL side of [`StepState`].
pub const WGSL: WgslModule = WgslModule { name: "sph/state", source: include_str!("state.wgsl") };
/// `finish_step`: the end of a step; imports [`STEP_COUNTERS`](super::STEP_COUNTERS).
pub const STEPS: WgslModule = WgslModule { name: "sph/steps", source: include_str!("steps.wgsl") };

gpu_struct! {
    /// The state that changes from step to step. It is computed on the device.
    pub struct StepState {
        /// The current time step in seconds.
        dt: f32,
        /// The largest stable time step; `dt` may be shorter to reach the end of a frame, or after an impact.
        stable_dt: f32,
        /// Simulated time in seconds: that of the frame's start plus what has passed since, so that the rounding errors of
        /// thousands of steps do not add up.
        time: f32,
        /// The remaining time of the frame in seconds.
        remaining: f32,
        /// 0 while steps run; [`COMPLETE`](Self::COMPLETE), [`SUSPENDED`](Self::SUSPENDED) or [`HELD`](Self::HELD) while passes
        /// have no effect.
        done: u32,
        /// Particles to process: all, or none while passes have no effect.
        run_count: u32,
        /// Steps of this frame.
        steps: u32,
        /// 1 if a step of this frame required less than `min_dt` for stability, and used `min_dt`.
        too_small: u32,
        /// Largest speed of the last step in m/s.
        max_speed: f32,
        /// Largest acceleration of the last step in m/s^2.
        max_acceleration: f32,
        /// Largest relative excess of density in this frame.
        density_error: f32,
        /// Length of the frame in seconds.
        frame_duration: f32,
        /// Iterations of the pressure solver in this frame.
        iterations: u32,
        /// Most iterations of one step in this frame.
        most_iterations: u32,
        /// Largest mean residual of the density that the pressure solver has accepted in this frame.
        residual: f32,
        /// Sum over the steps of this frame of the mean relative excess of density, computed from the positions at the
        /// beginning of the step.
        compression: f32,
        /// Iterations of the implicit viscosity in this frame.
        viscous_iterations: u32,
        /// Most of them in one step of this frame.
        most_viscous_iterations: u32,
        /// Largest residual of the viscosity that was accepted in this frame, as a part of its reference.
        viscous_residual: f32,
        /// Simulated time at the start of the frame in seconds, from the host.
        frame_start: f32,
        /// Largest speed of a point of a scripted body in this frame in m/s, from the host. Fluid does not know it before
        /// the body touches it, which must not be after a step of many spacings.
        body_speed: f32,
    }
}

impl StepState {
    /// The value of `done` once the frame is complete.
    pub const COMPLETE: u32 = 1;
    /// The value of `done` while a step waits for further iterations ([`passes::suspension`](crate::passes::suspension)).
    pub const SUSPENDED: u32 = 2;
    /// The value of `done` while no new step may begin.
    pub const HELD: u32 = 3;

    /// The words of the buffer from which a frame begins: its length and its start in seconds, and the largest speed of
    /// scripted bodies in it in m/s.
    pub fn frame_input(length: f32, start: f64, body_speed: f32) -> [f32; 3] {
        [length, start as f32, body_speed]
    }

    /// True if the step completes its frame. Both numbers are stored, so that all passes agree.
    pub fn is_last_step(&self) -> bool {
        self.dt >= self.remaining
    }
}
