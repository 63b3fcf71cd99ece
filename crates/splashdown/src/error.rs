//! The library's errors.

use splashdown_gpu::GpuError;

/// What can go wrong from a validated scene to a frame.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SimulationError {
    /// The device or its driver.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// Particles could not be placed.
    #[error(transparent)]
    Sample(#[from] crate::sample::SampleError),
    /// A body.
    #[error(transparent)]
    Body(#[from] crate::bodies::BodyError),
    /// The surface.
    #[error(transparent)]
    Surface(#[from] crate::surface::SurfaceError),
    /// A checkpoint.
    #[error(transparent)]
    Checkpoint(Box<crate::CheckpointError>),
    /// More than the device or the indices allow.
    #[error("{given} {what} are too many: at most {allowed} fit; {advice}")]
    TooMany {
        /// What there is too much of.
        what: &'static str,
        /// How many.
        given: u64,
        /// How many fit.
        allowed: u64,
        /// What to do.
        advice: String,
    },
    /// Every particle left the domain or became NaN.
    #[error("no particle is left at {time:.4} s: {reason}")]
    NothingLeft {
        /// Simulated time in seconds.
        time: f64,
        /// Where they went.
        reason: String,
    },
    /// The time step that stability asks for is below the scene's smallest.
    #[error(
        "at {time:.4} s the time step that keeps the simulation stable is below solver.min_dt = {min_dt:.3e} s (largest speed \
         {max_speed:.3e} m/s, acceleration {max_acceleration:.3e} m/s^2): look for particles placed inside one another, or \
         lower the speeds or min_dt"
    )]
    StepTooSmall {
        /// Simulated time in seconds.
        time: f64,
        /// The smallest step allowed in seconds.
        min_dt: f32,
        /// The largest speed in m/s.
        max_speed: f32,
        /// The largest acceleration in m/s^2.
        max_acceleration: f32,
    },
    /// A frame's length is negative, infinite or NaN.
    #[error("a simulation cannot advance by {seconds} s: give a finite number of seconds, zero or more")]
    BadDuration {
        /// The seconds given.
        seconds: f32,
    },
}

impl From<crate::foam::TooMuchFoam> for SimulationError {
    fn from(crate::foam::TooMuchFoam { given, allowed }: crate::foam::TooMuchFoam) -> Self {
        let advice = "lower foam.max_particles, or use a device with larger buffers (`splashdown doctor`)";
        Self::TooMany { what: "particles of foam", given, allowed, advice: advice.into() }
    }
}
