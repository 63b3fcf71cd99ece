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
    /// The largest stable time step in seconds; with an implicit pressure the steps of a frame are equal and shorter.
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
    /// Total number of times a velocity was limited: to half a spacing per step, with `dfsph` to `2 cfl_factor` spacings and at most
    /// the support radius less 0.7 spacings.
    /// Zero in a sound run.
    pub speed_limits: u32,
    /// The largest relative excess of the solver's density over the rest density in this call: max(0, rho/rho0 - 1). In the
    /// frames of a [`Run`](crate::Run) the larger one of excess and deficit by the positions of the particles, walls and
    /// bodies included: see [`DensityError`](crate::monitor::DensityError).
    pub density_error: f32,
    /// The relative excess of density that one particle in a hundred has, by the positions of the particles. Only in the frames
    /// of a [`Run`](crate::Run); otherwise 0.
    #[serde(default)]
    pub density_excess: f32,
    /// The relative deficit of density that one inner particle in a hundred has, by the positions of the particles. Only in
    /// the frames of a [`Run`](crate::Run); otherwise 0.
    pub density_deficit: f32,
    /// The largest speed at the end of this call in m/s.
    pub max_speed: f32,
    /// Pressure iterations since the start; zero with an explicit pressure, as all of the following.
    #[serde(default)]
    pub iterations: u64,
    /// The most pressure iterations of a step of this call.
    #[serde(default)]
    pub most_iterations: u32,
    /// The largest mean residual of the density at which the iterations of a step of this call stopped, predicted for the end
    /// of the step, as a part of the rest density.
    #[serde(default)]
    pub residual: f32,
    /// The mean of max(0, rho/rho0 - 1) over the particles and the steps of this call, computed from the positions.
    #[serde(default)]
    pub compression: f32,
    /// The same since the start.
    #[serde(default)]
    pub mean_compression: f64,
    /// Total number of steps whose iterations reached `max_iterations` before the tolerance.
    #[serde(default)]
    pub unconverged: u32,
    /// Viscosity iterations since the start; zero with an explicit viscosity, as all of the following.
    #[serde(default)]
    pub viscous_iterations: u64,
    /// The most viscosity iterations of a step of this call.
    #[serde(default)]
    pub most_viscous_iterations: u32,
    /// The largest residual of the velocity at which the viscosity iterations of a step of this call stopped, as a part of
    /// the change of the velocity by all other forces.
    #[serde(default)]
    pub viscous_residual: f32,
    /// Total number of steps whose viscosity iterations ended before the tolerance.
    #[serde(default)]
    pub viscous_unconverged: u32,
}
