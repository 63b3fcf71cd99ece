//! Counters of a step and the marks of dead particles.

use splashdown_gpu::WgslModule;

/// The WGSL side of [`StepCounters`].
pub const WGSL: WgslModule =
    WgslModule { name: "sph/step_counters", source: include_str!("step_counters.wgsl") };

/// Counters and maxima that passes raise atomically: the places of the words.
///
/// Maxima are of non-negative floats by their bits, whose order is that of the numbers, so the result does not depend
/// on the order of the invocations.
pub struct StepCounters;

impl StepCounters {
    /// Particles that left through an open side.
    pub const ESCAPED: usize = 0;
    /// Particles that became NaN or infinite.
    pub const NON_FINITE: usize = 1;
    /// Particles put back through a closed wall.
    pub const CORRECTIONS: usize = 2;
    /// Velocities limited to half a spacing per step.
    pub const LIMITED: usize = 3;
    /// Largest speed.
    pub const MAX_SPEED: usize = 4;
    /// Largest acceleration.
    pub const MAX_ACCELERATION: usize = 5;
    /// Largest relative excess of density.
    pub const MAX_EXCESS: usize = 6;
    /// Particles that went into sinks.
    pub const DRAINED: usize = 7;
    /// 1 if particles have moved since the last step was [ended](super::end_step).
    pub const MOVED: usize = 8;
    /// Number of words.
    pub const WORDS: usize = 9;
}

/// Mark of a particle that left, in the fourth component of its position.
pub const DEAD_ESCAPED: f32 = 1.0;
/// Mark of a particle that became NaN or infinite.
pub const DEAD_NON_FINITE: f32 = 2.0;
/// Mark of a place that waits for a particle to be born.
pub const DEAD_UNBORN: f32 = 3.0;
/// Mark of a particle that went into a sink.
pub const DEAD_DRAINED: f32 = 4.0;
