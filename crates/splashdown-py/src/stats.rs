//! Statistics of a simulation.

use pyo3::prelude::*;
use pyo3::types::PyDict;

macro_rules! stats {
    ($($(#[$doc:meta])* $name:ident: $kind:ty),+ $(,)?) => {
        /// The state of a simulation at the end of a call of `advance`, or of a frame. Totals count from the start.
        ///
        /// >>> stats = simulation.advance(0.005)
        /// >>> stats.escaped, stats.steps >= stats.steps_in_frame
        /// (0, True)
        #[pyclass(frozen, get_all, module = "splashdown")]
        #[derive(Clone, Copy)]
        pub struct Stats {
            $($(#[$doc])* $name: $kind),+
        }

        impl From<splashdown::Stats> for Stats {
            fn from(stats: splashdown::Stats) -> Self {
                Self { $($name: stats.$name),+ }
            }
        }

        #[pymethods]
        impl Stats {
            /// All values by name, for example for a row of a table.
            ///
            /// >>> simulation.stats.to_dict()["particles"] == len(simulation)
            /// True
            fn to_dict<'py>(this: &Bound<'py, Self>) -> PyResult<Bound<'py, PyDict>> {
                let (values, stats) = (PyDict::new(this.py()), this.get());
                $(values.set_item(stringify!($name), stats.$name)?;)+
                Ok(values)
            }

            fn __repr__(&self) -> String {
                let parts = [$(format!(concat!(stringify!($name), "={:?}"), self.$name)),+];
                format!("Stats({})", parts.join(", "))
            }
        }
    };
}

stats! {
    /// Simulated time in s.
    ///
    /// >>> round(simulation.advance(0.01).time, 4)  # s
    /// 0.01
    time: f64,
    /// Steps since the start.
    ///
    /// >>> first, second = simulation.advance(0.01), simulation.advance(0.01)
    /// >>> second.steps == first.steps + second.steps_in_frame
    /// True
    steps: u64,
    /// Steps of this call.
    ///
    /// >>> simulation.advance(0.01).steps_in_frame > 0
    /// True
    steps_in_frame: u32,
    /// The largest stable time step in s.
    ///
    /// >>> bool(0 < simulation.advance(0.01).dt <= 0.05)  # s
    /// True
    dt: f32,
    /// Particles inside the domain.
    ///
    /// >>> simulation.stats.particles
    /// 120
    particles: u32,
    /// Particles created by emitters.
    ///
    /// >>> simulation.advance(0.01).emitted
    /// 0
    emitted: u32,
    /// Particles that emitters could not create because the buffers were full.
    ///
    /// >>> simulation.advance(0.01).refused
    /// 0
    refused: u32,
    /// Particles removed by sinks.
    ///
    /// >>> simulation.advance(0.01).drained
    /// 0
    drained: u32,
    /// Particles that left through open sides.
    ///
    /// >>> simulation.advance(0.01).escaped
    /// 0
    escaped: u32,
    /// Particles removed because their position or velocity became NaN or infinite.
    ///
    /// >>> simulation.advance(0.01).non_finite
    /// 0
    non_finite: u32,
    /// How often a particle was moved back from behind a wall or out of a body.
    ///
    /// >>> simulation.advance(0.01).wall_corrections
    /// 0
    wall_corrections: u32,
    /// Particles inside a body at the end of a frame of a `Run`.
    ///
    /// >>> frame.stats.inside_bodies
    /// 0
    inside_bodies: u32,
    /// How often a velocity was limited to half a spacing per step.
    ///
    /// >>> simulation.advance(0.01).speed_limits
    /// 0
    speed_limits: u32,
    /// The largest relative excess of density over the rest density in this call. In the frames of a `Run` the larger one of
    /// excess and deficit by the positions of the particles.
    ///
    /// >>> bool(0 <= simulation.advance(0.01).density_error < 0.1)
    /// True
    density_error: f32,
    /// The relative excess of density that one particle in a hundred has, in the frames of a `Run`.
    ///
    /// >>> bool(0 <= frame.stats.density_excess < 0.1)
    /// True
    density_excess: f32,
    /// The relative deficit of density that one inner particle in a hundred has, in the frames of a `Run`.
    ///
    /// >>> bool(0 <= frame.stats.density_deficit < 0.2)
    /// True
    density_deficit: f32,
    /// The largest speed at the end of this call in m/s.
    ///
    /// >>> bool(0 < simulation.advance(0.01).max_speed < 1)  # m/s
    /// True
    max_speed: f32,
    /// Pressure iterations since the start; zero with an explicit pressure, as all of the following.
    ///
    /// >>> simulation.advance(0.01).iterations > 0
    /// True
    iterations: u64,
    /// The most pressure iterations of a step of this call.
    ///
    /// >>> 0 < simulation.advance(0.01).most_iterations <= 40
    /// True
    most_iterations: u32,
    /// The largest mean residual of the density at which the iterations of a step of this call stopped, as a part of the rest
    /// density.
    ///
    /// >>> bool(0 <= simulation.advance(0.01).residual <= 0.001)
    /// True
    residual: f32,
    /// The mean relative compression over the particles and the steps of this call, computed from the positions.
    ///
    /// >>> bool(0 <= simulation.advance(0.01).compression < 0.01)
    /// True
    compression: f32,
    /// The same since the start.
    ///
    /// >>> bool(0 <= simulation.advance(0.01).mean_compression < 0.01)
    /// True
    mean_compression: f64,
    /// Steps since the start whose iterations reached `max_iterations` before the tolerance.
    ///
    /// >>> simulation.advance(0.01).unconverged
    /// 0
    unconverged: u32,
    /// Viscosity iterations since the start; zero with an explicit viscosity, as all of the following.
    ///
    /// >>> simulation.advance(0.01).viscous_iterations
    /// 0
    viscous_iterations: u64,
    /// The most viscosity iterations of a step of this call.
    ///
    /// >>> simulation.advance(0.01).most_viscous_iterations
    /// 0
    most_viscous_iterations: u32,
    /// The largest residual of the velocity at which the viscosity iterations of a step of this call stopped, as a part of
    /// the change of the velocity by all other forces.
    ///
    /// >>> simulation.advance(0.01).viscous_residual
    /// 0.0
    viscous_residual: f32,
    /// Steps since the start whose viscosity iterations ended before the tolerance.
    ///
    /// >>> simulation.advance(0.01).viscous_unconverged
    /// 0
    viscous_unconverged: u32,
}
