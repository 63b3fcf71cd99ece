//! What a simulation tells about itself.

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
    /// Particles that emitters made, in all.
    pub emitted: u32,
    /// Particles that emitters found no room for, in all.
    pub refused: u32,
    /// Particles that went into sinks, in all.
    pub drained: u32,
    /// Particles that left through an open side, in all.
    pub escaped: u32,
    /// Particles whose position or velocity became NaN or infinite, in all; they are taken out.
    pub non_finite: u32,
    /// Where the first such particle (by id) was last seen, in metres.
    pub non_finite_place: [f32; 3],
    /// The id of that particle.
    pub non_finite_id: u32,
    /// How often a particle had to be put back through a closed wall or out of a body, in all. Zero in a sound run.
    pub wall_corrections: u32,
    /// Particles inside a body, by the host's own look-up at the end of a frame of a [`Run`](crate::Run); zero
    /// in a sound run.
    pub inside_bodies: u32,
    /// How often a velocity had to be limited to half a spacing per step, in all. Zero in a sound run.
    pub speed_limits: u32,
    /// The largest relative excess of density over the rest density in this call: max(0, rho/rho0 - 1).
    pub density_error: f32,
    /// The largest speed at the end of this call in m/s.
    pub max_speed: f32,
}
