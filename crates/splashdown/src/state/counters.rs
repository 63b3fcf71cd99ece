//! Counters of a step, and the marks of particles that are not active.

use splashdown_gpu::WgslModule;

/// The WGSL side of [`StepCounters`].
pub const WGSL: WgslModule =
    WgslModule { name: "sph/step_counters", source: include_str!("step_counters.wgsl") };

/// The indices of the counters and maxima that passes update atomically.
///
/// A maximum is stored as the bits of a non-negative float, whose order as integers is that of the numbers. So the
/// result does not depend on the order of the invocations.
pub struct StepCounters;

impl StepCounters {
    /// Particles that left through an open side.
    pub const ESCAPED: usize = 0;
    /// Particles that became NaN or infinite.
    pub const NON_FINITE: usize = 1;
    /// Particles moved back from behind a closed wall.
    pub const CORRECTIONS: usize = 2;
    /// Velocities limited to the largest motion per step ([`Params::longest_motion`](super::Params)).
    pub const LIMITED: usize = 3;
    /// Largest speed.
    pub const MAX_SPEED: usize = 4;
    /// Largest acceleration.
    pub const MAX_ACCELERATION: usize = 5;
    /// Largest relative excess of density.
    pub const MAX_EXCESS: usize = 6;
    /// Particles removed by sinks.
    pub const DRAINED: usize = 7;
    /// 1 if particles have moved since the last step was [ended](super::end_step).
    pub const MOVED: usize = 8;
    /// Steps whose pressure did not converge.
    pub const UNCONVERGED: usize = 9;
    /// 1 if the pressure or the viscosity of the present step did not converge, so that the next step is shorter.
    pub const SHORTEN: usize = 10;
    /// Largest pressure over the rest density that limits the next step, with implicit pressure: a mean over the steps.
    pub const MAX_PRESSURE: usize = 11;
    /// Steps whose viscosity did not converge.
    pub const VISCOUS_UNCONVERGED: usize = 12;
    /// Number of words.
    pub const WORDS: usize = 13;
}

/// Mark of a particle that left through an open side, in the fourth component of its position.
pub const DEAD_ESCAPED: f32 = 1.0;
/// Mark of a particle that became NaN or infinite.
pub const DEAD_NON_FINITE: f32 = 2.0;
/// Mark of a particle that is not yet emitted.
pub const DEAD_UNBORN: f32 = 3.0;
/// Mark of a particle that a sink has removed.
pub const DEAD_DRAINED: f32 = 4.0;
