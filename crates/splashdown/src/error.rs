//! The errors of the library. [`SimulationError`] contains those of its parts.

pub use splashdown_gpu::GpuError;
pub use splashdown_io::IoError;

pub use crate::bodies::BodyError;
pub use crate::checkpoint::CheckpointError;
pub use crate::sample::SampleError;
pub use crate::scene::SceneErrors;
pub use crate::solid::SolidError;
pub use crate::surface::SurfaceError;

/// Errors of a simulation.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SimulationError {
    /// The device or its driver failed.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// Particles could not be placed.
    #[error(transparent)]
    Sample(#[from] SampleError),
    /// A body could not be loaded.
    #[error(transparent)]
    Body(#[from] BodyError),
    /// The surface could not be reconstructed.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
    /// A checkpoint could not be used.
    #[error(transparent)]
    Checkpoint(Box<CheckpointError>),
    /// A count exceeds what the device or 32-bit indices allow.
    #[error("{given} {what} are too many: at most {allowed} fit; {advice}")]
    TooMany {
        /// The counted objects.
        what: &'static str,
        /// The count requested.
        given: u64,
        /// The largest count possible.
        allowed: u64,
        /// Advice on how to stay below the limit.
        advice: String,
    },
    /// Every particle left the domain or became NaN.
    #[error("no particle is left at {time:.4} s: {reason}")]
    NothingLeft {
        /// Simulated time in seconds.
        time: f64,
        /// The numbers of particles lost by each cause.
        reason: String,
    },
    /// The fluid has burst: the monitor found values that are meaningless.
    #[error(
        "the fluid has burst: {message}. The run stops here; to continue: --on-burst warn, in Python on_burst=\"warn\""
    )]
    Burst {
        /// Simulated time in seconds.
        time: f64,
        /// What is wrong, where, the likely cause, and what to change.
        message: String,
    },
    /// The time step required for stability is below `solver.min_dt`.
    #[error(
        "at {time:.4} s the time step that keeps the simulation stable is below solver.min_dt = {min_dt:.3e} s (largest speed \
         {max_speed:.3e} m/s, acceleration {max_acceleration:.3e} m/s^2): {}",
        cause.as_deref().unwrap_or("look for particles placed inside one another, or lower the speeds or min_dt")
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
        /// What the monitor of a run found: what is wrong, where, the likely cause, and what to change.
        cause: Option<String>,
    },
    /// There is not one value per particle.
    #[error(
        "{given} {what} are given, but there are {expected} particles: give one for each, in the order of the particles"
    )]
    Count {
        /// The quantity, such as `velocities`.
        what: &'static str,
        /// The number given.
        given: usize,
        /// The number of particles.
        expected: usize,
    },
    /// Two particles have the same id.
    #[error("two particles have the id {id}: give unique ids, or none")]
    DuplicateId {
        /// The id.
        id: u32,
    },
    /// A position or velocity is NaN or infinite.
    #[error("{what}[{index}] is ({}, {}, {}): give finite numbers", value[0], value[1], value[2])]
    NotFinite {
        /// `positions` or `velocities`.
        what: &'static str,
        /// The index of the particle.
        index: usize,
        /// The value.
        value: [f32; 3],
    },
    /// A position is outside the domain.
    #[error(
        "position {index} is ({}, {}, {}) m, outside the domain from ({}, {}, {}) to ({}, {}, {}) m: move it inside",
        position[0], position[1], position[2], min[0], min[1], min[2], max[0], max[1], max[2]
    )]
    OutsideDomain {
        /// The index of the particle.
        index: usize,
        /// The position in m.
        position: [f32; 3],
        /// The lower corner of the domain in m.
        min: [f32; 3],
        /// The upper corner of the domain in m.
        max: [f32; 3],
    },
    /// The duration of a frame is negative, infinite or NaN.
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
