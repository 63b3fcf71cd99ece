//! Statistics of a simulation.

/// The state of a simulation at the end of a call of [`Simulation::advance`](crate::Simulation::advance).
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
#[non_exhaustive]
pub struct Stats {
    /// Simulated time in seconds.
    pub time: f64,
    /// Steps since the start.
    pub steps: u64,
    /// Steps of this call.
    pub steps_in_frame: u32,
    /// The last time step in seconds.
    pub dt: f32,
    /// Particles inside the domain.
    pub particles: u32,
    /// Total number of particles created by emitters.
    pub emitted: u32,
    /// Total number of particles that emitters could not create because the buffers were full.
    pub refused: u32,
    /// Total number of particles removed by sinks.
    pub drained: u32,
    /// Total number of particles that left through an open side.
    pub escaped: u32,
    /// Total number of particles removed because their position or velocity became NaN or infinite.
    pub non_finite: u32,
    /// The last finite position of the first such particle (by id), in metres.
    pub non_finite_place: [f32; 3],
    /// The id of that particle.
    pub non_finite_id: u32,
    /// Total number of times a particle was moved back from behind a closed wall or out of a body. Zero in a sound
    /// run.
    pub wall_corrections: u32,
    /// Particles inside a body at the end of a frame of a [`Run`](crate::Run), by a separate test on the host. Zero
    /// in a sound run.
    pub inside_bodies: u32,
    /// Total number of times a velocity was limited to half a spacing per step. Zero in a sound run.
    pub speed_limits: u32,
    /// The largest relative excess of density over the rest density in this call: max(0, rho/rho0 - 1).
    pub density_error: f32,
    /// The largest speed at the end of this call in m/s.
    pub max_speed: f32,
}
